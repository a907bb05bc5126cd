// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/instance/consensus/edge_contraction.h"

#include <tsl/robin_map.h>

#include <algorithm>
#include <iterator>
#include <numeric>
#include <queue>
#include <tuple>
#include <utility>

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

/// Edges are kept only between clusters that some entity joins:
/// no others can come to speak for joining.
///
/// How often two clusters met is counted when their edge comes first in the queue. Until then the
/// edge knows of fewer meetings and speaks more for joining than it will. So a cluster that takes in
/// a hundred super-points does not count anew, each time, how often it met each neighbour.
class EdgeContraction {
 public:
  EdgeContraction(std::span<const Label> roots, const EntitySightings& sightings,
                  double apart_weight)
      : apart_weight_(apart_weight), roots_(roots) {
    for (const Label root : roots_) {
      Cluster& cluster = clusters_.emplace_back();
      for (const EntitySighting& sighting : sightings.at(root)) cluster.push_back({sighting, 1});
    }
    edges_of_.resize(roots_.size());
    grown_at_.resize(roots_.size(), now_);
    into_.resize(roots_.size());
    std::iota(into_.begin(), into_.end(), Node{0});
    oldest_ = into_;
    add_edges();
  }

  void run() {
    while (!queue_.empty()) {
      const Queued next = queue_.top();
      queue_.pop();
      // Edges change while they wait: only one that still is what it was when queued counts.
      if (!(queued(next.edge) == next)) continue;
      Edge& edge = edges_[next.edge];
      if (edge.counted_at < std::max(grown_at_[edge.a], grown_at_[edge.b])) {
        edge.evidence.met = evidence_between(clusters_[edge.a], clusters_[edge.b]).met;
        edge.counted_at = now_;
      }
      if (edge.evidence.weight(apart_weight_) == next.weight)
        contract(next.edge);
      else
        enqueue(next.edge);
    }
  }

  std::map<Label, Label> objects() const {
    std::map<Label, Label> objects;
    for (Node node = 0; node < roots_.size(); ++node)
      objects.emplace_hint(objects.end(), roots_[node], roots_[oldest_[cluster_with(node)]]);
    return objects;
  }

 private:
  using EdgeIndex = std::uint32_t;
  using Edges = tsl::robin_map<Node, EdgeIndex>;  // by the other cluster

  struct Edge {
    Node a, b;                     ///< clusters, by the node that all others of them went into
    Evidence evidence;             ///< all that was joined; met so often or oftener
    std::uint32_t counted_at = 0;  ///< then `met` was all; it is, if neither has grown since
  };

  struct Queued {
    double weight;
    Node older, younger;  ///< the oldest of each cluster
    EdgeIndex edge;
    bool operator==(const Queued&) const = default;
    /// Among equal weights the older labels go first.
    bool operator<(const Queued& other) const {
      return std::tie(weight, other.older, other.younger) <
             std::tie(other.weight, older, younger);
    }
  };

  /// One for each pair that some entity shows together.
  void add_edges() {
    std::vector<std::pair<EntitySighting, Node>> shown;
    for (Node node = 0; node < clusters_.size(); ++node)
      for (const Presence& presence : clusters_[node]) shown.emplace_back(presence.sighting, node);
    std::sort(shown.begin(), shown.end());
    for (std::size_t i = 0; i < shown.size(); ++i)
      for (std::size_t j = i + 1; j < shown.size() && shown[j].first == shown[i].first; ++j)
        join_once(shown[i].second, shown[j].second);
    for (EdgeIndex edge = 0; edge < edges_.size(); ++edge) enqueue(edge);
  }

  void join_once(Node a, Node b) {
    const auto [at, is_new] =
        edges_of_[a].try_emplace(b, static_cast<EdgeIndex>(edges_.size()));
    if (is_new) {
      edges_.push_back({a, b, {}});
      edges_of_[b].emplace(a, at->second);
    }
    Evidence& evidence = edges_[at->second].evidence;
    ++evidence.joined, ++evidence.met;
  }

  Queued queued(EdgeIndex index) const {
    const Edge& edge = edges_[index];
    const auto [older, younger] = std::minmax(oldest_[edge.a], oldest_[edge.b]);
    return {edge.evidence.weight(apart_weight_), older, younger, index};
  }

  void enqueue(EdgeIndex edge) {
    const Queued entry = queued(edge);
    if (entry.weight > 0) queue_.push(entry);
  }

  /// Makes one cluster of two, at the cost of the one with fewer edges; edges of both to the same
  /// third are added up.
  void contract(EdgeIndex between) {
    Node keep = edges_[between].a, drop = edges_[between].b;
    if (edges_of_[keep].size() < edges_of_[drop].size()) std::swap(keep, drop);
    clusters_[keep] = united(clusters_[keep], clusters_[drop]);
    Cluster().swap(clusters_[drop]);
    into_[drop] = keep;
    grown_at_[keep] = ++now_;
    remove(between);
    const Edges moved = std::exchange(edges_of_[drop], {});
    for (const auto& [other, edge] : moved) move(edge, other, drop, keep);
    if (oldest_[drop] < oldest_[keep]) {
      oldest_[keep] = oldest_[drop];
      for (const auto& [other, edge] : edges_of_[keep]) enqueue(edge);
    } else {
      for (const auto& [other, edge] : moved) enqueue(edges_of_[keep].at(other));
    }
  }

  void remove(EdgeIndex index) {
    Edge& edge = edges_[index];
    edges_of_[edge.a].erase(edge.b);
    edges_of_[edge.b].erase(edge.a);
    edge.evidence = {};
  }

  /// An edge of `drop` becomes one of `keep`, or adds to that which is there.
  void move(EdgeIndex index, Node other, Node drop, Node keep) {
    edges_of_[other].erase(drop);
    const auto [at, is_new] = edges_of_[keep].try_emplace(other, index);
    Edge& edge = edges_[index];
    if (is_new) {
      (edge.a == drop ? edge.a : edge.b) = keep;
      edges_of_[other].emplace(keep, index);
    } else {
      Evidence& sum = edges_[at->second].evidence;
      sum = sum + edge.evidence;
      edge.evidence = {};  // no entry in the queue counts any more
    }
  }

  Node cluster_with(Node node) const {
    while (into_[node] != node) node = into_[node];
    return node;
  }

  double apart_weight_;
  std::span<const Label> roots_;
  std::vector<Cluster> clusters_;
  std::vector<Node> into_;    ///< the cluster each went into; itself while it is one
  std::vector<Node> oldest_;  ///< of each cluster
  std::uint32_t now_ = 1;     ///< counts contractions
  std::vector<std::uint32_t> grown_at_;
  std::vector<Edge> edges_;
  std::vector<Edges> edges_of_;
  std::priority_queue<Queued> queue_;
};

}  // namespace

std::map<Label, Label> contract_edges(std::span<const Label> roots,
                                      const EntitySightings& sightings, double apart_weight) {
  EdgeContraction graph(roots, sightings, apart_weight);
  graph.run();
  return graph.objects();
}

}  // namespace ovimap
