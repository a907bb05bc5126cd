// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/instance/entity_consensus.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <queue>
#include <tuple>

#include "ovimap/base/config.h"

namespace ovimap {

namespace {

using Node = std::uint32_t;  ///< place of a root among all roots in order

/// How many super-points of a cluster an entity shows.
struct Presence {
  EntitySighting sighting;
  int count = 0;
};
using Cluster = std::vector<Presence>;  // by sighting

Cluster united(const Cluster& a, const Cluster& b) {
  Cluster both;
  both.reserve(a.size() + b.size());
  std::merge(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both),
             [](const Presence& x, const Presence& y) { return x.sighting < y.sighting; });
  std::size_t kept = 0;
  for (std::size_t i = 1; i < both.size(); ++i) {
    if (both[i].sighting == both[kept].sighting)
      both[kept].count += both[i].count;
    else
      both[++kept] = both[i];
  }
  both.resize(std::min(both.size(), kept + 1));
  return both;
}

/// What the frames say of all pairs with one super-point in each of two clusters.
struct Evidence {
  std::int64_t joined = 0, met = 0;  ///< sums over pairs of frames; met: joined or apart

  Evidence operator+(const Evidence& other) const {
    return {joined + other.joined, met + other.met};
  }
  double weight(double apart_weight) const {
    return static_cast<double>(joined) - apart_weight * static_cast<double>(met - joined);
  }
};

Evidence evidence_between(const Cluster& a, const Cluster& b) {
  Evidence sum;
  for (auto i = a.begin(), j = b.begin(); i != a.end() && j != b.end();) {
    const std::uint32_t frame = std::max(i->sighting.frame, j->sighting.frame);
    while (i != a.end() && i->sighting.frame < frame) ++i;
    while (j != b.end() && j->sighting.frame < frame) ++j;
    std::int64_t in_a = 0, in_b = 0;
    for (auto k = j; k != b.end() && k->sighting.frame == frame; ++k) in_b += k->count;
    auto partner = j;
    for (; i != a.end() && i->sighting.frame == frame; ++i) {
      in_a += i->count;
      while (partner != b.end() && partner->sighting < i->sighting) ++partner;
      if (partner != b.end() && partner->sighting == i->sighting)
        sum.joined += std::int64_t{i->count} * partner->count;
    }
    sum.met += in_a * in_b;
  }
  return sum;
}

/// Greedy additive edge contraction. Edges are kept only between clusters that some entity joins:
/// no others can come to speak for joining.
class Contraction {
 public:
  /// Of these roots, in ascending order.
  Contraction(std::vector<Label> roots, const EntitySightings& sightings, double apart_weight)
      : apart_weight_(apart_weight), roots_(std::move(roots)) {
    for (const Label root : roots_) {
      Cluster& cluster = clusters_.emplace_back();
      for (const EntitySighting& sighting : sightings.at(root)) cluster.push_back({sighting, 1});
    }
    edges_.resize(roots_.size());
    into_.resize(roots_.size());
    std::iota(into_.begin(), into_.end(), Node{0});
    for (const auto& [a, b] : joined_pairs()) {
      const Evidence evidence = evidence_between(clusters_[a], clusters_[b]);
      edges_[a].push_back({b, evidence});  // pairs ascend, so both lists do
      edges_[b].push_back({a, evidence});
      enqueue(a, b, evidence);
    }
  }

  void run() {
    while (!queue_.empty()) {
      const Queued next = queue_.top();
      queue_.pop();
      // Edges change while they wait: only one that still is what it was when queued counts.
      const auto edge = find_edge(edges_[next.a], next.b);
      if (edge != edges_[next.a].end() && edge->other == next.b &&
          edge->evidence.weight(apart_weight_) == next.weight)
        contract(next.a, next.b);
    }
  }

  void write_objects(std::map<Label, Label>& objects) const {
    for (Node node = 0; node < roots_.size(); ++node)
      objects[roots_[node]] = roots_[object_of(node)];
  }

 private:
  struct Edge {
    Node other;
    Evidence evidence;
  };
  using Edges = std::vector<Edge>;  // by other

  struct Queued {
    double weight;
    Node a, b;  ///< a < b
    /// Among equal weights the older labels go first.
    bool operator<(const Queued& other) const {
      return std::tie(weight, other.a, other.b) < std::tie(other.weight, a, b);
    }
  };

  /// All pairs that some entity shows together, in order.
  std::vector<std::pair<Node, Node>> joined_pairs() const {
    std::vector<std::pair<EntitySighting, Node>> shown;
    for (Node node = 0; node < clusters_.size(); ++node)
      for (const Presence& presence : clusters_[node]) shown.emplace_back(presence.sighting, node);
    std::sort(shown.begin(), shown.end());
    std::vector<std::pair<Node, Node>> pairs;
    for (std::size_t i = 0; i < shown.size(); ++i)
      for (std::size_t j = i + 1; j < shown.size() && shown[j].first == shown[i].first; ++j)
        pairs.emplace_back(shown[i].second, shown[j].second);
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    return pairs;
  }

  static Edges::iterator find_edge(Edges& edges, Node other) {
    return std::lower_bound(edges.begin(), edges.end(), other,
                            [](const Edge& edge, Node node) { return edge.other < node; });
  }

  void enqueue(Node a, Node b, const Evidence& evidence) {
    const double weight = evidence.weight(apart_weight_);
    if (weight > 0) queue_.push({weight, std::min(a, b), std::max(a, b)});
  }

  /// Makes one cluster of two; their edges are added up.
  void contract(Node keep, Node drop) {
    const Edges sums = added_edges(keep, drop);
    for (const Edge& edge : edges_[drop]) {
      Edges& others = edges_[edge.other];
      others.erase(find_edge(others, drop));
    }
    Edges().swap(edges_[drop]);
    for (const Edge& edge : sums) {
      Edges& others = edges_[edge.other];
      const auto found = find_edge(others, keep);
      if (found != others.end() && found->other == keep)
        found->evidence = edge.evidence;
      else
        others.insert(found, {keep, edge.evidence});
      enqueue(keep, edge.other, edge.evidence);
    }
    edges_[keep] = sums;
    clusters_[keep] = united(clusters_[keep], clusters_[drop]);
    Cluster().swap(clusters_[drop]);
    into_[drop] = keep;
  }

  /// The edges of two clusters to others, as those of one. Where only one has an edge, what frames
  /// say of the other one is counted now.
  Edges added_edges(Node keep, Node drop) const {
    const Edges &kept = edges_[keep], &dropped = edges_[drop];
    Edges sums;
    sums.reserve(kept.size() + dropped.size());
    for (auto i = kept.begin(), j = dropped.begin(); i != kept.end() || j != dropped.end();) {
      const bool in_kept = i != kept.end() && (j == dropped.end() || i->other <= j->other);
      const bool in_dropped = j != dropped.end() && (i == kept.end() || j->other <= i->other);
      const Node other = in_kept ? i->other : j->other;
      if (other != keep && other != drop)
        sums.push_back({other, (in_kept ? i->evidence : between(keep, other)) +
                                   (in_dropped ? j->evidence : between(drop, other))});
      i += in_kept, j += in_dropped;
    }
    return sums;
  }

  Evidence between(Node a, Node b) const { return evidence_between(clusters_[a], clusters_[b]); }

  Node object_of(Node node) const {
    while (into_[node] != node) node = into_[node];
    return node;
  }

  double apart_weight_;
  std::vector<Label> roots_;
  std::vector<Cluster> clusters_;
  std::vector<Edges> edges_;
  std::vector<Node> into_;  ///< the cluster each went into; itself while it is one
  std::priority_queue<Queued> queue_;
};

}  // namespace

void list_fields(ConsensusConfig& config, ConfigFields& fields) {
  fields.add("apart_weight", config.apart_weight, 0.f, 1000.f,
             "what a frame that keeps two super-points apart weighs against one that joins them");
}

void EntityConsensus::observe(const std::map<Label, std::uint16_t>& entity_of_root) {
  std::map<std::uint16_t, Label> shown;
  for (const auto& [root, entity] : entity_of_root) {
    sightings_[root].push_back({frames_, entity});
    enter(root);
    link(shown.try_emplace(entity, root).first->second, root);
  }
  ++frames_;
}

/// The root is in a part, and its part has changed.
void EntityConsensus::enter(Label root) {
  const auto [found, is_new] = part_of_.try_emplace(root, last_part_ + 1);
  if (is_new) parts_[++last_part_] = {root};
  changed_.insert(found->second);
}

/// Makes one part of two, at the cost of the smaller.
void EntityConsensus::link(Label a, Label b) {
  Part into = part_of_.at(a), from = part_of_.at(b);
  if (into == from) return;
  if (parts_.at(into).size() < parts_.at(from).size()) std::swap(into, from);
  const std::vector<Label> moved = std::move(parts_.extract(from).mapped());
  for (const Label root : moved) part_of_[root] = into;
  std::vector<Label>& members = parts_.at(into);
  members.insert(members.end(), moved.begin(), moved.end());
  changed_.erase(from);
  changed_.insert(into);
}

const std::map<Label, Label>& EntityConsensus::objects() {
  for (const Part part : changed_) {
    std::vector<Label> roots = parts_.at(part);
    std::sort(roots.begin(), roots.end());
    Contraction graph(std::move(roots), sightings_, config_.apart_weight);
    graph.run();
    graph.write_objects(objects_);
  }
  changed_.clear();
  return objects_;
}

void EntityConsensus::restore(EntitySightings sightings, std::uint32_t frames) {
  *this = EntityConsensus(config_);
  sightings_ = std::move(sightings);
  frames_ = frames;
  std::map<EntitySighting, Label> shown;
  for (const auto& [root, seen] : sightings_) {
    enter(root);
    for (const EntitySighting& sighting : seen)
      link(shown.try_emplace(sighting, root).first->second, root);
    if (!seen.empty()) frames_ = std::max(frames_, seen.back().frame + 1);
  }
}

}  // namespace ovimap
