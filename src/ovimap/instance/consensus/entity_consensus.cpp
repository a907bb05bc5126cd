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
}

void EntityConsensus::observe(const std::map<Label, std::uint16_t>& entity_of_root,
                              std::span<const float> ratings) {
  for (const auto& [root, entity] : entity_of_root) {
    const float rating = entity <= ratings.size() ? std::clamp(ratings[entity - 1u], 0.f, 1.f) : 1.f;
    sightings_[root].push_back(
        {frames_, entity, static_cast<std::uint8_t>(std::lround(kHighestRating * rating))});
    shown_.insert(root);
  }
  ++frames_;
}

std::map<Label, Label> EntityConsensus::update() {
  std::set<Label> roots = std::exchange(shown_, {}), objects;
  for (const Label root : roots)
    if (const auto known = object_of_.find(root); known != object_of_.end())
      objects.insert(known->second);
  for (const Label object : objects) {
    const std::vector<Label>& members = members_.at(object);
    roots.insert(members.begin(), members.end());
  }
  return regrouped(contract_edges(std::vector<Label>(roots.begin(), roots.end()), sightings_,
                                  config_.apart_weight));
}

std::map<Label, Label> EntityConsensus::settle() {
  return regrouped(contract_edges(take_all(), sightings_, config_.apart_weight));
}

std::map<Label, Label> EntityConsensus::settle(const SuperPointShapes& shapes) {
  return regrouped(contract_by_judge(take_all(), sightings_, shapes, config_.apart_weight));
}

/// Every root; none waits for update() any more.
std::vector<Label> EntityConsensus::take_all() {
  shown_.clear();
  std::vector<Label> all;
  for (const auto& [root, seen] : sightings_) all.push_back(root);
  return all;
}

/// Notes what belongs together: of an object all roots or none.
std::map<Label, Label> EntityConsensus::regrouped(std::map<Label, Label> object_of) {
  regroup(object_of);
  return object_of;
}

void EntityConsensus::regroup(const std::map<Label, Label>& object_of) {
  for (const auto& [root, object] : object_of)
    if (const auto known = object_of_.find(root); known != object_of_.end())
      members_.erase(known->second);
  for (const auto& [root, object] : object_of) {
    object_of_[root] = object;
    members_[object].push_back(root);
  }
}

void EntityConsensus::restore(EntitySightings sightings, std::uint32_t frames,
                              const std::map<Label, Label>& objects) {
  *this = EntityConsensus(config_);
  sightings_ = std::move(sightings);
  frames_ = frames;
  std::map<Label, Label> object_of;
  for (const auto& [root, seen] : sightings_) {
    const auto known = objects.find(root);
    object_of[root] = known == objects.end() ? root : known->second;
    if (!seen.empty()) frames_ = std::max(frames_, seen.back().frame + 1);
  }
  regroup(object_of);
}

}  // namespace ovimap
