// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/instance/consensus/entity_consensus.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ovimap/base/config.h"
#include "ovimap/instance/consensus/judged_contraction.h"

namespace ovimap {

void list_fields(ConsensusConfig& config, ConfigFields& fields) {
  fields.add("apart_weight", config.apart_weight, 0.f, 1000.f,
             "what a frame that keeps two super-points apart weighs against one that joins them");
  fields.add("recent_sightings", config.recent_sightings, 1, 1000000,
             "of each super-point that count while frames come; all at the end");
}

/// What update() contracts: super-points in sight, and for each object that they are in its others.
struct EntityConsensus::Graph {
  struct Part {
    Label oldest;        ///< root
    Object resting = 0;  ///< all others of this object; 0: one super-point in sight
  };
  const std::set<Label>& shown;
  std::vector<Part> parts = {};  ///< the nodes, oldest first
  tsl::robin_map<Object, Node> resting = {};
  std::vector<std::pair<Node, Node>> tied = {};
};

void EntityConsensus::observe(const std::map<Label, std::uint16_t>& entity_of_root,
                              std::span<const float> ratings) {
  for (const auto& [root, entity] : entity_of_root) {
    const float rating =
        entity <= ratings.size() ? std::clamp(ratings[entity - 1u], 0.f, 1.f) : 1.f;
    add_sighting(
        root, {frames_, entity, static_cast<std::uint8_t>(std::lround(kHighestRating * rating))});
    shown_.insert(root);
  }
  ++frames_;
}

void EntityConsensus::add_sighting(Label root, const EntitySighting& sighting) {
  sightings_[root].push_back(sighting);
  if (shown_in_.size() <= sighting.frame) shown_in_.resize(sighting.frame + std::size_t{1});
  shown_in_[sighting.frame].push_back({root, sighting});
}

std::vector<RegroupedObject> EntityConsensus::update() {
  const std::set<Label> shown = std::exchange(shown_, {});
  for (const Label root : shown)
    if (!object_of_.contains(root)) move(root, ++last_object_);
  const Graph graph = graph_of(shown);
  const std::vector<Node> oldest =
      contract_nodes(presences_in(graph), graph.tied, config_.apart_weight);
  std::map<Node, std::vector<Node>> clusters;
  for (Node node = 0; node < oldest.size(); ++node) clusters[oldest[node]].push_back(node);
  std::vector<RegroupedObject> regrouped;
  for (const auto& [first, cluster] : clusters) regrouped.push_back(regroup(graph, cluster));
  return regrouped;
}

EntityConsensus::Graph EntityConsensus::graph_of(const std::set<Label>& shown) const {
  Graph graph{shown};
  std::set<Object> objects;
  for (const Label root : shown) {
    graph.parts.push_back({root});
    objects.insert(object_of_.at(root));
  }
  for (const Object object : objects) {
    const std::set<Label>& members = members_.at(object);
    const auto first = std::find_if(members.begin(), members.end(),
                                    [&](Label root) { return !shown.contains(root); });
    if (first != members.end()) graph.parts.push_back({*first, object});
  }
  std::sort(graph.parts.begin(), graph.parts.end(),
            [](const auto& a, const auto& b) { return a.oldest < b.oldest; });
  for (Node node = 0; node < graph.parts.size(); ++node)
    if (const Object object = graph.parts[node].resting) graph.resting[object] = node;
  for (Node node = 0; node < graph.parts.size(); ++node) {
    if (graph.parts[node].resting) continue;
    const auto others = graph.resting.find(object_of_.at(graph.parts[node].oldest));
    if (others != graph.resting.end()) graph.tied.emplace_back(node, others->second);
  }
  return graph;
}

/// Where super-points in sight were seen lately, and where the others were in the same frames.
std::vector<Presences> EntityConsensus::presences_in(const Graph& graph) const {
  std::vector<Presences> presences(graph.parts.size());
  std::set<std::uint32_t> frames;
  for (Node node = 0; node < graph.parts.size(); ++node) {
    if (graph.parts[node].resting) continue;
    const std::vector<EntitySighting>& all = *sightings_.find(graph.parts[node].oldest);
    const std::size_t recent =
        std::min(all.size(), static_cast<std::size_t>(config_.recent_sightings));
    for (const EntitySighting& sighting : std::span(all).last(recent)) {
      presences[node].push_back({sighting, 1});
      frames.insert(sighting.frame);
    }
  }
  for (const std::uint32_t frame : frames) see_resting(graph, frame, presences);
  return presences;
}

void EntityConsensus::see_resting(const Graph& graph, std::uint32_t frame,
                                  std::vector<Presences>& presences) const {
  std::vector<std::pair<Node, EntitySighting>> seen;
  for (const auto& [root, sighting] : shown_in_[frame]) {
    const auto node = graph.resting.find(object_of_.at(root));
    if (node != graph.resting.end() && !graph.shown.contains(root))
      seen.emplace_back(node->second, sighting);
  }
  std::sort(seen.begin(), seen.end());
  for (std::size_t i = 0; i < seen.size(); ++i) {
    Presences& of_node = presences[seen[i].first];
    if (i > 0 && seen[i] == seen[i - 1])
      ++of_node.back().count;
    else
      of_node.push_back({seen[i].second, 1});
  }
}

/// Makes one object of a cluster. It goes on as the largest of those that rest in it.
RegroupedObject EntityConsensus::regroup(const Graph& graph, std::span<const Node> cluster) {
  Object object = 0;
  RegroupedObject regrouped;
  for (const Node node : cluster) {
    const auto [oldest, resting] = graph.parts[node];
    if (!resting) continue;
    if (object && members_.at(resting).size() <= members_.at(object).size()) continue;
    object = resting;
    regrouped.resting = oldest;
  }
  if (!object) object = ++last_object_;
  for (const Node node : cluster) {
    const auto [oldest, resting] = graph.parts[node];
    if (!resting) regrouped.roots.push_back(oldest);
    if (!resting || resting == object) continue;
    for (const Label root : members_.at(resting))
      if (!graph.shown.contains(root)) regrouped.roots.push_back(root);
  }
  std::sort(regrouped.roots.begin(), regrouped.roots.end());
  for (const Label root : regrouped.roots) move(root, object);
  return regrouped;
}

void EntityConsensus::move(Label root, Object object) {
  const Object before = std::exchange(object_of_[root], object);
  if (before == object) return;
  if (const auto left = members_.find(before); left != members_.end()) {
    left.value().erase(root);
    if (left->second.empty()) members_.erase(left);
  }
  members_[object].insert(root);
}

std::map<Label, Label> EntityConsensus::settle() {
  return regrouped(contract_edges(take_all(), sightings(), config_.apart_weight));
}

std::map<Label, Label> EntityConsensus::settle(const SuperPointShapes& shapes, bool masked) {
  return regrouped(
      contract_by_judge(take_all(), sightings(), masked, shapes, config_.apart_weight));
}

/// Every root; none waits for update() any more.
std::vector<Label> EntityConsensus::take_all() {
  shown_.clear();
  std::vector<Label> all;
  for (const auto& [root, seen] : sightings()) all.push_back(root);
  return all;
}

/// Notes what belongs together, of all roots.
std::map<Label, Label> EntityConsensus::regrouped(std::map<Label, Label> object_of) {
  std::map<Label, Object> number_of;
  for (const auto& [root, object] : object_of) {
    const auto [number, is_new] = number_of.try_emplace(object, last_object_ + 1);
    last_object_ += is_new;
    move(root, number->second);
  }
  return object_of;
}

void EntityConsensus::restore(EntitySightings sightings, std::uint32_t frames,
                              const std::map<Label, Label>& objects) {
  *this = EntityConsensus(config_);
  frames_ = frames;
  std::map<Label, Label> object_of;
  for (const auto& [root, seen] : sightings) {
    const auto known = objects.find(root);
    object_of[root] = known == objects.end() ? root : known->second;
    if (!seen.empty()) frames_ = std::max(frames_, seen.back().frame + 1);
    sightings_[root];  // also one that no frame shows
    for (const EntitySighting& sighting : seen) add_sighting(root, sighting);
  }
  regrouped(object_of);
}

}  // namespace ovimap
