// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/instance/entity_consensus.h"

#include <algorithm>
#include <queue>
#include <tuple>

#include "ovimap/base/config.h"

namespace ovimap {

namespace {

/// The graph of greedy additive edge contraction.
class Contraction {
 public:
  void add_edge(Label a, Label b, float weight) {
    edges_[a][b] = edges_[b][a] = weight;
    offer(a, b, weight);
  }

  void run() {
    while (!queue_.empty()) {
      const auto [weight, a, b] = queue_.top();
      queue_.pop();
      // Edges change while they wait: only one that still is what it was when queued counts.
      const auto from = edges_.find(a);
      if (from == edges_.end()) continue;
      const auto edge = from->second.find(b);
      if (edge != from->second.end() && edge->second == weight) contract(a, b);
    }
  }

  std::map<Label, Label> objects() const {
    std::map<Label, Label> result;
    for (const auto& [label, edges] : edges_) result[label] = label;
    for (const auto& [drop, keep] : into_) result[drop] = object_of(keep);
    return result;
  }

 private:
  using Queued = std::tuple<float, Label, Label>;

  /// Among equal weights the older labels go first.
  struct Later {
    bool operator()(const Queued& a, const Queued& b) const {
      if (std::get<0>(a) != std::get<0>(b)) return std::get<0>(a) < std::get<0>(b);
      return std::tie(std::get<1>(a), std::get<2>(a)) > std::tie(std::get<1>(b), std::get<2>(b));
    }
  };

  void offer(Label a, Label b, float weight) {
    if (weight > 0) queue_.emplace(weight, std::min(a, b), std::max(a, b));
  }

  void contract(Label keep, Label drop) {
    const std::map<Label, float> moved = std::move(edges_.at(drop));
    edges_.erase(drop);
    into_[drop] = keep;
    std::map<Label, float>& kept = edges_.at(keep);
    kept.erase(drop);
    for (const auto& [other, weight] : moved) {
      if (other == keep) continue;
      edges_.at(other).erase(drop);
      const float sum = kept[other] += weight;
      edges_.at(other)[keep] = sum;
      offer(keep, other, sum);
    }
  }

  Label object_of(Label label) const {
    for (auto found = into_.find(label); found != into_.end(); found = into_.find(label))
      label = found->second;
    return label;
  }

  std::map<Label, std::map<Label, float>> edges_;
  std::map<Label, Label> into_;
  std::priority_queue<Queued, std::vector<Queued>, Later> queue_;
};

}  // namespace

void list_fields(ConsensusConfig& config, ConfigFields& fields) {
  fields.add("apart_weight", config.apart_weight, 0.f, 1000.f,
             "what a frame that keeps two super-points apart weighs against one that joins them");
}

void EntityConsensus::observe(std::span<const Sighting> sightings) {
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    for (std::size_t j = i + 1; j < sightings.size(); ++j) {
      PairCount& count = pairs_[{sightings[i].root, sightings[j].root}];
      ++(sightings[i].entity == sightings[j].entity ? count.joined : count.apart);
    }
  }
}

std::map<Label, Label> EntityConsensus::objects() const {
  Contraction graph;
  for (const auto& [pair, count] : pairs_)
    graph.add_edge(
        pair.first, pair.second,
        static_cast<float>(count.joined) - config_.apart_weight * static_cast<float>(count.apart));
  graph.run();
  return graph.objects();
}

}  // namespace ovimap
