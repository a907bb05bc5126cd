// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/instance/entity_consensus.h"

#include <algorithm>
#include <iterator>
#include <queue>
#include <tuple>

#include "ovimap/base/config.h"

namespace ovimap {

namespace {

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

/// Sum of joined - apart_weight * apart over all pairs with one super-point in each cluster.
double weight_between(const Cluster& a, const Cluster& b, double apart_weight) {
  std::int64_t joined = 0, met = 0;
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
        joined += std::int64_t{i->count} * partner->count;
    }
    met += in_a * in_b;
  }
  return static_cast<double>(joined) - apart_weight * static_cast<double>(met - joined);
}

/// Greedy additive edge contraction. Edges are kept only between clusters that some entity joins:
/// no others can come to speak for joining.
class Contraction {
 public:
  Contraction(const EntitySightings& sightings, double apart_weight) : apart_weight_(apart_weight) {
    std::map<EntitySighting, std::vector<Label>> shown;
    for (const auto& [root, seen] : sightings) {
      Cluster& cluster = clusters_[root];
      for (const EntitySighting& sighting : seen) {
        cluster.push_back({sighting, 1});
        shown[sighting].push_back(root);
      }
    }
    for (const auto& [sighting, roots] : shown)
      for (std::size_t i = 0; i < roots.size(); ++i)
        for (std::size_t j = i + 1; j < roots.size(); ++j)
          if (!edges_[roots[i]].contains(roots[j]))
            set_edge(roots[i], roots[j],
                     weight_between(clusters_.at(roots[i]), clusters_.at(roots[j]), apart_weight_));
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
    for (const auto& [root, cluster] : clusters_) result[root] = root;
    for (const auto& [drop, keep] : into_) result[drop] = object_of(keep);
    return result;
  }

 private:
  using Edges = std::map<Label, double>;
  using Queued = std::tuple<double, Label, Label>;

  /// Among equal weights the older labels go first.
  struct Later {
    bool operator()(const Queued& a, const Queued& b) const {
      if (std::get<0>(a) != std::get<0>(b)) return std::get<0>(a) < std::get<0>(b);
      return std::tie(std::get<1>(a), std::get<2>(a)) > std::tie(std::get<1>(b), std::get<2>(b));
    }
  };

  void set_edge(Label a, Label b, double weight) {
    edges_[a][b] = edges_[b][a] = weight;
    if (weight > 0) queue_.emplace(weight, std::min(a, b), std::max(a, b));
  }

  double weight_to(const Edges& known, Label from, Label other) const {
    const auto found = known.find(other);
    return found != known.end()
               ? found->second
               : weight_between(clusters_.at(from), clusters_.at(other), apart_weight_);
  }

  void contract(Label keep, Label drop) {
    Edges kept = std::move(edges_.at(keep)), dropped = std::move(edges_.at(drop));
    edges_.erase(drop);
    kept.erase(drop);
    dropped.erase(keep);
    edges_.at(keep).clear();
    Edges sums;
    for (const auto& [other, weight] : kept) sums[other] = weight + weight_to(dropped, drop, other);
    for (const auto& [other, weight] : dropped) {
      edges_.at(other).erase(drop);
      if (!kept.contains(other)) sums[other] = weight + weight_to(kept, keep, other);
    }
    for (const auto& [other, sum] : sums) set_edge(keep, other, sum);
    clusters_.at(keep) = united(clusters_.at(keep), clusters_.at(drop));
    into_[drop] = keep;
  }

  Label object_of(Label label) const {
    for (auto found = into_.find(label); found != into_.end(); found = into_.find(label))
      label = found->second;
    return label;
  }

  double apart_weight_;
  std::map<Label, Cluster> clusters_;
  std::map<Label, Edges> edges_;
  std::map<Label, Label> into_;
  std::priority_queue<Queued, std::vector<Queued>, Later> queue_;
};

}  // namespace

void list_fields(ConsensusConfig& config, ConfigFields& fields) {
  fields.add("apart_weight", config.apart_weight, 0.f, 1000.f,
             "what a frame that keeps two super-points apart weighs against one that joins them");
}

void EntityConsensus::observe(const std::map<Label, std::uint16_t>& entity_of_root) {
  for (const auto& [root, entity] : entity_of_root) sightings_[root].push_back({frames_, entity});
  ++frames_;
}

void EntityConsensus::merge(Label keep, Label drop) {
  const auto dropped = sightings_.extract(drop);
  if (dropped.empty()) return;
  std::vector<EntitySighting>& kept = sightings_[keep];
  std::vector<EntitySighting> both;
  std::set_union(kept.begin(), kept.end(), dropped.mapped().begin(), dropped.mapped().end(),
                 std::back_inserter(both), [](const EntitySighting& a, const EntitySighting& b) {
                   return a.frame < b.frame;
                 });
  kept = std::move(both);
}

std::map<Label, Label> EntityConsensus::objects() const {
  Contraction graph(sightings_, config_.apart_weight);
  graph.run();
  return graph.objects();
}

void EntityConsensus::restore(EntitySightings sightings) {
  sightings_ = std::move(sightings);
  frames_ = 0;
  for (const auto& [root, seen] : sightings_)
    if (!seen.empty()) frames_ = std::max(frames_, seen.back().frame + 1);
}

}  // namespace ovimap
