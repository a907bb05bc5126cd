// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/instance/instance_registry.h"

#include <algorithm>
#include <numeric>
#include <set>

#include "ovimap/base/config.h"

namespace ovimap {

namespace {

/// Segment indices, largest first; equals in order.
std::vector<std::size_t> by_area(const Segments& segments) {
  std::vector<std::size_t> order(segments.segments.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return segments.segments[a].area_px > segments.segments[b].area_px;
  });
  return order;
}

}  // namespace

void list_fields(InstanceConfig& config, ConfigFields& fields) {
  fields.add_choice<InstanceReading>("instances", config.instances,
                                     {{"superpoints", InstanceReading::kSuperPoints},
                                      {"entity_votes", InstanceReading::kEntityVotes}},
                                     "what an instance is when there are 2D masks");
  fields.add("min_vote_share", config.min_vote_share, 0.f, 100.f,
             "votes needed per frame without such a vote");
  list_fields(config.merging, fields);
}

void InstanceRegistry::observe(const Segments& segments,
                               std::span<const SegmentAssociation> associations,
                               std::int64_t frame_index, bool has_entities, LabelForest& forest) {
  const bool by_votes = has_entities && config_.instances == InstanceReading::kEntityVotes;
  if (by_votes) vote(segments, associations, forest);
  for (const auto& [keep, drop] : merging_.observe(associations, forest)) merge(keep, drop);
  if (!by_votes) see_super_points(associations, forest);
  count_views(associations, frame_index, forest);
}

void InstanceRegistry::vote(const Segments& segments,
                            std::span<const SegmentAssociation> associations,
                            const LabelForest& forest) {
  std::map<std::uint16_t, InstanceId> instance_of_entity;
  std::set<InstanceId> used;
  std::set<Label> seen;
  std::set<std::pair<Label, InstanceId>> voted;  // pieces that share a super-point are one voice
  for (std::size_t i : by_area(segments)) {
    const Label root = forest.root(associations[i].label);
    SuperPoint& point = super_points_[root];
    if (seen.insert(root).second) ++point.frames_seen;
    const std::uint16_t entity = segments.segments[i].entity;
    if (entity == 0) continue;
    auto known = instance_of_entity.find(entity);
    if (known == instance_of_entity.end()) {
      const InstanceId best = best_free_instance(point, used);
      used.insert(best);
      known = instance_of_entity.emplace(entity, best).first;
    }
    if (voted.emplace(root, known->second).second) ++point.votes[known->second];
  }
}

/// The instance with most votes that no other entity of the frame has taken; a new one when there
/// is none.
InstanceId InstanceRegistry::best_free_instance(const SuperPoint& point,
                                                const std::set<InstanceId>& used) {
  InstanceId best = 0;
  for (const auto& [id, votes] : point.votes)
    if (!used.contains(id) && (best == 0 || votes > point.votes.at(best))) best = id;
  return best == 0 ? ++last_id_ : best;
}

/// Every super-point an instance of its own: the frame had no 2D masks, or the paper's reading is
/// chosen.
void InstanceRegistry::see_super_points(std::span<const SegmentAssociation> associations,
                                        const LabelForest& forest) {
  std::set<Label> roots;
  for (const SegmentAssociation& segment : associations) roots.insert(forest.root(segment.label));
  for (Label root : roots) {
    SuperPoint& point = super_points_[root];
    ++point.frames_seen;
    const InstanceId own = point.votes.empty() ? ++last_id_ : instance_of(root);
    ++point.votes[own];
  }
}

void InstanceRegistry::merge(Label keep, Label drop) {
  const InstanceId kept_instance = instance_of(keep), dropped_instance = instance_of(drop);
  SuperPoint& into = super_points_[keep];
  const SuperPoint& from = super_points_[drop];
  into.frames_seen += from.frames_seen;  // as the votes, so that their ratio keeps its meaning
  for (const auto& [id, votes] : from.votes) into.votes[id] += votes;
  super_points_.erase(drop);
  if (kept_instance == 0 || dropped_instance == 0 || kept_instance == dropped_instance) return;
  if (!owns_super_point(kept_instance) || !owns_super_point(dropped_instance))
    unify(kept_instance, dropped_instance);
}

bool InstanceRegistry::owns_super_point(InstanceId id) const {
  return std::any_of(super_points_.begin(), super_points_.end(),
                     [&](const auto& entry) { return instance_of(entry.first) == id; });
}

/// The younger id becomes an alias of the older, with everything it had.
void InstanceRegistry::unify(InstanceId a, InstanceId b) {
  const InstanceId keep = std::min(a, b), drop = std::max(a, b);
  aliases_[drop] = keep;
  for (auto& [id, target] : aliases_)
    if (target == drop) target = keep;
  for (auto& [label, point] : super_points_) {
    const auto found = point.votes.find(drop);
    if (found == point.votes.end()) continue;
    point.votes[keep] += found->second;
    point.votes.erase(drop);
  }
  const auto dropped = records_.find(drop);
  if (dropped == records_.end()) return;
  const auto [kept, created] = records_.try_emplace(keep, dropped->second);
  if (!created) {
    kept->second.views = std::max(kept->second.views, dropped->second.views);
    kept->second.first_frame = std::min(kept->second.first_frame, dropped->second.first_frame);
    kept->second.last_frame = std::max(kept->second.last_frame, dropped->second.last_frame);
  }
  records_.erase(drop);
}

void InstanceRegistry::count_views(std::span<const SegmentAssociation> associations,
                                   std::int64_t frame_index, const LabelForest& forest) {
  std::set<InstanceId> seen;
  for (const SegmentAssociation& segment : associations)
    seen.insert(instance_of(forest.root(segment.label)));
  seen.erase(0);
  for (InstanceId id : seen) {
    const auto [found, created] =
        records_.try_emplace(id, InstanceRecord{0, frame_index, frame_index});
    ++found->second.views;
    found->second.last_frame = frame_index;
  }
}

InstanceId InstanceRegistry::instance_of(Label root) const {
  const auto found = super_points_.find(root);
  if (found == super_points_.end()) return 0;
  const SuperPoint& point = found->second;
  InstanceId best = 0;
  int most = 0;
  for (const auto& [id, votes] : point.votes)
    if (votes > most) best = id, most = votes;
  const bool by_votes = config_.instances == InstanceReading::kEntityVotes;
  const auto unsupported = static_cast<float>(point.frames_seen - most);
  if (by_votes && point.votes.size() > 0 &&
      static_cast<float>(most) <= config_.min_vote_share * unsupported)
    return 0;
  return best;
}

std::vector<InstanceId> InstanceRegistry::instance_table(const LabelForest& forest) const {
  std::vector<InstanceId> table(forest.roots().size(), 0);
  for (Label label = 1; label < table.size(); ++label)
    table[label] = forest.root(label) == label ? instance_of(label) : table[forest.root(label)];
  return table;
}

InstanceId InstanceRegistry::resolve(InstanceId id) const {
  const auto found = aliases_.find(id);
  return found == aliases_.end() ? id : found->second;
}

void InstanceRegistry::restore(State state) {
  super_points_ = std::move(state.super_points);
  records_ = std::move(state.records);
  aliases_ = std::move(state.aliases);
  merging_.restore(std::move(state.pair_counts));
  last_id_ = state.last_id;
}

}  // namespace ovimap
