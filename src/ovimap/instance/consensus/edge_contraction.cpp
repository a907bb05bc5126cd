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

Presences united(const Presences& a, const Presences& b) {
  Presences both;
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
  bool tied = false;

  Evidence operator+(const Evidence& other) const {
    return {joined + other.joined, met + other.met, tied || other.tied};
  }
  double weight(double apart_weight) const {
    constexpr double kTie = 1e-6;  // less than any frame says
    return static_cast<double>(joined) - apart_weight * static_cast<double>(met - joined) +
           (tied ? kTie : 0);
  }
};

Evidence evidence_between(const Presences& a, const Presences& b) {
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

/// Edges are kept only between clusters that some entity joins, or that are tied:
/// no others can come to speak for joining.
///
/// How often two clusters met is counted when their edge comes first in the queue. Until then the
/// edge knows of fewer meetings and speaks more for joining than it will. So a cluster that takes
/// in a hundred super-points does not count anew, each time, how often it met each neighbour.
class EdgeContraction {
 public:
  EdgeContraction(std::vector<Presences> nodes, std::span<const std::pair<Node, Node>> tied,
                  double apart_weight)
      : apart_weight_(apart_weight),
        clusters_(std::move(nodes)),
        into_(clusters_.size()),
        grown_at_(clusters_.size(), now_),
        edges_of_(clusters_.size()) {
    std::iota(into_.begin(), into_.end(), Node{0});
    oldest_ = into_;
    add_edges(tied);
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

  std::vector<Node> oldest() const {
    std::vector<Node> oldest(clusters_.size());
    for (Node node = 0; node < clusters_.size(); ++node) oldest[node] = oldest_[cluster_with(node)];
    return oldest;
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
      return std::tie(weight, other.older, other.younger) < std::tie(other.weight, older, younger);
    }
  };

  /// One for each pair that some entity shows together, or that is tied.
  void add_edges(std::span<const std::pair<Node, Node>> tied) {
    struct Shown {
      EntitySighting sighting;
      Node node;
      int count;
    };
    std::vector<Shown> shown;
    for (Node node = 0; node < clusters_.size(); ++node)
      for (const Presence& presence : clusters_[node])
        shown.push_back({presence.sighting, node, presence.count});
    std::sort(shown.begin(), shown.end(), [](const Shown& a, const Shown& b) {
      return std::tie(a.sighting, a.node) < std::tie(b.sighting, b.node);
    });
    for (std::size_t i = 0; i < shown.size(); ++i)
      for (std::size_t j = i + 1; j < shown.size() && shown[j].sighting == shown[i].sighting; ++j) {
        Evidence& evidence = between(shown[i].node, shown[j].node);
        const std::int64_t pairs = std::int64_t{shown[i].count} * shown[j].count;
        evidence.joined += pairs, evidence.met += pairs;
      }
    for (const auto& [a, b] : tied) between(a, b).tied = true;
    for (EdgeIndex edge = 0; edge < edges_.size(); ++edge) enqueue(edge);
  }

  Evidence& between(Node a, Node b) {
    const auto [at, is_new] = edges_of_[a].try_emplace(b, static_cast<EdgeIndex>(edges_.size()));
    if (is_new) {
      edges_.push_back({a, b, {}});
      edges_of_[b].emplace(a, at->second);
    }
    return edges_[at->second].evidence;
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
    Presences().swap(clusters_[drop]);
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
  std::uint32_t now_ = 1;  ///< counts contractions
  std::vector<Presences> clusters_;
  std::vector<Node> into_;    ///< the cluster each went into; itself while it is one
  std::vector<Node> oldest_;  ///< of each cluster
  std::vector<std::uint32_t> grown_at_;
  std::vector<Edges> edges_of_;
  std::vector<Edge> edges_;
  std::priority_queue<Queued> queue_;
};

}  // namespace

std::vector<Node> contract_nodes(std::vector<Presences> nodes,
                                 std::span<const std::pair<Node, Node>> tied, double apart_weight) {
  EdgeContraction graph(std::move(nodes), tied, apart_weight);
  graph.run();
  return graph.oldest();
}

std::map<Label, Label> contract_edges(std::span<const Label> roots,
                                      const EntitySightings& sightings, double apart_weight) {
  std::vector<Presences> nodes;
  for (const Label root : roots) {
    Presences& presences = nodes.emplace_back();
    for (const EntitySighting& sighting : sightings.at(root)) presences.push_back({sighting, 1});
  }
  const std::vector<Node> oldest = contract_nodes(std::move(nodes), {}, apart_weight);
  std::map<Label, Label> objects;
  for (std::size_t i = 0; i < roots.size(); ++i)
    objects.emplace_hint(objects.end(), roots[i], roots[oldest[i]]);
  return objects;
}

}  // namespace ovimap
