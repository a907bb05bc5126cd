// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/instance/instance_registry.h"

#include <algorithm>
#include <numeric>
#include <set>

#include "ovimap/base/config.h"
#include "ovimap/instance/instance_aliases.h"

namespace ovimap {

namespace {

/// The lower of two ids; 0 is none.
InstanceId older(InstanceId a, InstanceId b) {
  return a == 0 || (b != 0 && b < a) ? b : a;
}

/// Objects by the oldest root of each root's.
std::vector<RegroupedObject> listed(const std::map<Label, Label>& object_of) {
  std::map<Label, RegroupedObject> objects;
  for (const auto& [root, object] : object_of) objects[object].roots.push_back(root);
  std::vector<RegroupedObject> list;
  for (auto& [object, regrouped] : objects) list.push_back(std::move(regrouped));
  return list;
}

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

InstanceRecord record_of(const std::map<Label, SuperPoint>& known,
                         std::span<const Label> super_points) {
  FrameRuns seen;
  InstanceRecord record;
  for (const Label label : super_points) {
    const auto found = known.find(label);
    if (found == known.end() || found->second.seen.runs().empty()) continue;
    const SuperPoint& point = found->second;
    const bool first = seen.runs().empty();
    record.first_frame =
        first ? point.first_frame : std::min(record.first_frame, point.first_frame);
    record.last_frame = first ? point.last_frame : std::max(record.last_frame, point.last_frame);
    seen |= point.seen;
  }
  record.views = seen.count();
  return record;
}

void list_fields(InstanceConfig& config, ConfigFields& fields) {
  fields.add_choice<InstanceReading>("instances", config.instances,
                                     {{"superpoints", InstanceReading::kSuperPoints},
                                      {"entity_votes", InstanceReading::kEntityVotes},
                                      {"consensus", InstanceReading::kConsensus}},
                                     "what an instance is when there are 2D masks");
  fields.add("min_vote_share", config.min_vote_share, 0.f, 100.f,
             "votes needed per frame without such a vote");
  fields.add(
      "judged", config.judged,
      "objects are found at the end by a judge of super-points that looks at their surfaces");
  list_fields(config.consensus, fields);
  list_fields(config.merging, fields);
}

void InstanceRegistry::observe(const Segments& segments,
                               std::span<const SegmentAssociation> associations,
                               std::int64_t frame_index, bool has_entities, LabelForest& forest) {
  if (config_.instances == InstanceReading::kConsensus) {
    see_entities(segments, associations, forest, has_entities);
    group(consensus_.update());
  } else {
    const bool by_votes = has_entities && config_.instances == InstanceReading::kEntityVotes;
    if (by_votes) vote(segments, associations, forest);
    merge_super_points(associations, forest);
    if (!by_votes) see_super_points(associations, forest);
  }
  count_sightings(associations, frame_index, forest);
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

/// Which super-points the frame's entities show: an entity shows one when it covers most of what is
/// in sight of it.
void InstanceRegistry::see_entities(const Segments& segments,
                                    std::span<const SegmentAssociation> associations,
                                    const LabelForest& forest, bool has_entities) {
  const auto entity_of = [&](std::size_t i) {
    return has_entities ? segments.segments[i].entity : static_cast<std::uint16_t>(i + 1);
  };
  std::map<Label, std::map<std::uint16_t, int>> areas;
  for (std::size_t i = 0; i < associations.size(); ++i)
    for (const ShownLabel& shown : associations[i].shown)
      areas[forest.root(shown.label)][entity_of(i)] += shown.points;
  std::map<Label, std::uint16_t> entity_of_root;
  for (const auto& [root, by_entity] : areas) {
    SuperPoint& point = super_points_[root];
    ++point.frames_seen;
    int in_sight = 0;
    for (const auto& [entity, points] : by_entity) in_sight += points;
    const auto most =
        std::max_element(by_entity.begin(), by_entity.end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; });
    if (most->first == 0 || 2 * most->second <= in_sight) continue;
    if (point.votes.empty()) point.votes[++last_id_] = 0;
    ++point.votes.begin()->second;
    entity_of_root[root] = most->first;
  }
  consensus_.observe(entity_of_root, segments.ratings);
}

void InstanceRegistry::settle() {
  if (config_.instances == InstanceReading::kConsensus) group(listed(consensus_.settle()));
}

void InstanceRegistry::settle(const SuperPointShapes& shapes, bool masked) {
  group(listed(consensus_.settle(shapes, masked)));
}

/// An object goes by the oldest id among its super-points. The others are its aliases for as long
/// as they belong to it.
void InstanceRegistry::group(std::vector<RegroupedObject> objects) {
  std::map<InstanceId, std::size_t> object_with;  // those whose super-points are all named
  for (std::size_t i = 0; i < objects.size(); ++i)
    for (const Label root : objects[i].roots) object_with[own_id(root)] = i;
  std::vector<InstanceId> ids;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const InstanceId now = objects[i].resting ? resolve(own_id(objects[i].resting)) : 0;
    const auto namesake = object_with.find(now);
    const bool left = namesake != object_with.end() && namesake->second != i;
    InstanceId id = left ? 0 : now;
    for (const Label root : objects[i].roots) id = older(id, own_id(root));
    if (objects[i].resting && id != now) {  // then it is new to those that rest as well
      const std::set<Label>& all = consensus_.object_with(objects[i].resting);
      objects[i].roots.assign(all.begin(), all.end());
      for (const Label root : all) id = older(id, own_id(root));
    }
    ids.push_back(id);
  }
  for (std::size_t i = 0; i < objects.size(); ++i)
    for (const Label root : objects[i].roots) {
      const InstanceId own = own_id(root);
      if (own == 0) continue;
      if (own == ids[i])
        aliases_.erase(own);
      else
        aliases_[own] = ids[i];
    }
  for (const RegroupedObject& object : objects)
    for (const Label root : object.roots) regroup(root);
}

/// That which a super-point got when it was first seen in an entity; 0: a map file may lack it.
InstanceId InstanceRegistry::own_id(Label root) const {
  const SuperPoint* const point = super_points_.find(root);
  return point == nullptr || point->votes.empty() ? 0 : point->votes.begin()->first;
}

void InstanceRegistry::merge_super_points(std::span<const SegmentAssociation> associations,
                                          LabelForest& forest) {
  for (const auto& [keep, drop] : merging_.observe(associations, forest)) merge(keep, drop);
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
    if (point.votes.empty()) point.votes[++last_id_] = 0;
    const InstanceId now = instance_of(root);
    ++point.votes[now == 0 ? point.votes.begin()->first : now];
  }
}

void InstanceRegistry::merge(Label keep, Label drop) {
  const InstanceId kept_instance = instance_of(keep), dropped_instance = instance_of(drop);
  absorb(keep, drop);
  if (kept_instance == 0 || dropped_instance == 0 || kept_instance == dropped_instance) return;
  if (!owns_super_point(kept_instance) || !owns_super_point(dropped_instance))
    unify(kept_instance, dropped_instance);
}

/// Adds the evidence of `drop` to that of `keep`.
void InstanceRegistry::absorb(Label keep, Label drop) {
  SuperPoint& into = super_points_[keep];
  const SuperPoint& from = super_points_[drop];
  into.frames_seen += from.frames_seen;  // as the votes, so that their ratio keeps its meaning
  for (const auto& [id, votes] : from.votes) into.votes[id] += votes;
  if (!from.seen.runs().empty()) {
    const bool first = into.seen.runs().empty();
    into.first_frame = first ? from.first_frame : std::min(into.first_frame, from.first_frame);
    into.last_frame = first ? from.last_frame : std::max(into.last_frame, from.last_frame);
    into.seen |= from.seen;
  }
  leave(drop);
  super_points_.erase(drop);
  regroup(keep);
}

bool InstanceRegistry::owns_super_point(InstanceId id) const {
  return std::any_of(super_points().begin(), super_points().end(),
                     [&](const auto& entry) { return instance_of(entry.first) == id; });
}

/// The younger id becomes an alias of the older, with everything it had.
void InstanceRegistry::unify(InstanceId a, InstanceId b) {
  const InstanceId keep = std::min(a, b), drop = std::max(a, b);
  for (const auto& [id, target] : aliases())
    if (target == drop) aliases_[id] = keep;
  aliases_[drop] = keep;
  std::vector<Label> changed = super_points_of(drop);
  for (const auto& [label, point] : super_points()) {
    const auto found = point.votes.find(drop);
    if (found == point.votes.end()) continue;
    auto& votes = super_points_[label].votes;
    votes[keep] += found->second;
    votes.erase(drop);
    changed.push_back(label);
  }
  for (const Label root : changed) regroup(root);
}

void InstanceRegistry::count_sightings(std::span<const SegmentAssociation> associations,
                                       std::int64_t frame_index, const LabelForest& forest) {
  std::set<Label> roots;
  for (const SegmentAssociation& segment : associations) roots.insert(forest.root(segment.label));
  for (const Label root : roots) {
    SuperPoint& point = super_points_[root];
    if (point.seen.runs().empty()) point.first_frame = frame_index;
    point.last_frame = frame_index;
    point.seen.add(frames_);
    regroup(root);
  }
  ++frames_;
}

/// Brings the list of instances up to date with what a super-point is now.
void InstanceRegistry::regroup(Label root) {
  const InstanceId id = instance_of(root);
  const auto known = member_of_.find(root);
  if ((known == member_of_.end() ? 0 : known->second) == id) return;
  leave(root);
  if (id == 0) return;
  member_of_[root] = id;
  std::vector<Label>& members = members_[id];
  members.insert(std::lower_bound(members.begin(), members.end(), root), root);
}

void InstanceRegistry::leave(Label root) {
  const auto known = member_of_.find(root);
  if (known == member_of_.end()) return;
  std::vector<Label>& members = members_[known->second];
  std::erase(members, root);
  if (members.empty()) members_.erase(known->second);
  member_of_.erase(known);
}

const std::vector<Label>& InstanceRegistry::super_points_of(InstanceId id) const {
  static const std::vector<Label> kNone;
  const std::vector<Label>* const found = members_.find(id);
  return found == nullptr ? kNone : *found;
}

bool InstanceRegistry::seen_in(InstanceId id, int frames) const {
  FrameRuns seen;
  for (const Label label : super_points_of(id)) {
    const SuperPoint* const point = super_points_.find(label);
    if (point == nullptr) continue;
    if (point->seen.count() >= frames) return true;
    seen |= point->seen;
  }
  return seen.count() >= frames;
}

InstanceId InstanceRegistry::instance_of(Label root) const {
  const SuperPoint* const point = super_points_.find(root);
  if (point == nullptr) return 0;
  InstanceId best = 0;
  int most = 0;
  for (const auto& [id, votes] : point->votes)
    if (votes > most) best = id, most = votes;
  return supported(*point, most) ? resolve(best) : 0;
}

/// Whether enough of the frames that showed the super-point voted so.
bool InstanceRegistry::supported(const SuperPoint& point, int votes) const {
  if (config_.instances == InstanceReading::kSuperPoints) return true;
  const auto unsupported = static_cast<float>(point.frames_seen - votes);
  return static_cast<float>(votes) > config_.min_vote_share * unsupported;
}

std::vector<InstanceId> InstanceRegistry::instance_table(const LabelForest& forest) const {
  std::vector<InstanceId> table(forest.roots().size(), 0);
  for (Label label = 1; label < table.size(); ++label)
    table[label] = forest.root(label) == label ? instance_of(label) : table[forest.root(label)];
  return table;
}

InstanceId InstanceRegistry::resolve(InstanceId id) const {
  return resolve_alias_by([this](InstanceId asked) { return aliases_.find(asked); }, id);
}

void InstanceRegistry::restore(State state) {
  super_points_ = IndexedMap(std::move(state.super_points));
  aliases_ = IndexedMap(std::move(state.aliases));
  merging_.restore(std::move(state.pair_counts));
  std::map<InstanceId, Label> object_with;
  std::map<Label, Label> object_of;
  for (const auto& [root, point] : super_points())
    if (!point.votes.empty())
      object_of[root] = object_with.try_emplace(resolve(own_id(root)), root).first->second;
  consensus_.restore(std::move(state.entity_sightings),
                     static_cast<std::uint32_t>(state.entity_frames), object_of);
  frames_ = static_cast<std::uint32_t>(state.frames);
  last_id_ = state.last_id;
  members_ = {};
  member_of_.clear();
  for (const auto& [root, point] : super_points()) regroup(root);
}

}  // namespace ovimap
