// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/revise/map_merge.h"

#include <algorithm>
#include <chrono>

#include "ovimap/base/config.h"
#include "ovimap/instance/object_boxes.h"
#include "ovimap/io/corrections/map_corrections.h"
#include "ovimap/io/corrections/map_edit_log.h"
#include "ovimap/map/fusion/map_fusion.h"
#include "ovimap/pipeline/alignment/object_layout.h"
#include "ovimap/pipeline/revise/object_overlap.h"
#include "ovimap/pipeline/revise/percent_text.h"

namespace ovimap {

namespace {

/// By how much the numbers of the second map grow.
struct Offsets {
  Label label = 0;
  InstanceId instance = 0;
  std::int64_t frame = 0;
  std::uint32_t mask_frame = 0;
  std::uint32_t labelled_frame = 0;
  std::int64_t edit = 0;
};

InstanceId highest_id(const MapRecord& map) {
  InstanceId highest = map.registry.last_id;
  for (const InstanceSummary& instance : map.instances) highest = std::max(highest, instance.id);
  for (const auto& [id, name] : map.names) highest = std::max(highest, id);
  return highest;
}

Offsets offsets_after(const MapRecord& a, Label labels) {
  Offsets offsets;
  offsets.label = labels;
  offsets.instance = highest_id(a);
  for (const FrameLogEntry& frame : a.frames)
    offsets.frame = std::max(offsets.frame, frame.index + 1);
  for (const auto& [label, point] : a.registry.super_points)
    offsets.frame = std::max(offsets.frame, point.last_frame + 1);
  offsets.labelled_frame = static_cast<std::uint32_t>(a.registry.frames);
  for (const auto& [label, seen] : a.registry.entity_sightings)
    for (const EntitySighting& sighting : seen)
      offsets.mask_frame = std::max(offsets.mask_frame, sighting.frame + 1);
  offsets.edit = a.edits.empty() ? 0 : a.edits.back().id;
  return offsets;
}

void append_registry(InstanceRegistry::State& a, const InstanceRegistry::State& b,
                     const Offsets& by, InstanceId highest_b) {
  for (const auto& [label, point] : b.super_points) {
    SuperPoint& moved = a.super_points[label + by.label];
    moved.frames_seen = point.frames_seen;
    for (const auto& [id, votes] : point.votes) moved.votes[id + by.instance] = votes;
    std::vector<FrameRuns::Run> seen = point.seen.runs();
    for (FrameRuns::Run& run : seen)
      run = {run.begin + by.labelled_frame, run.end + by.labelled_frame};
    moved.seen = FrameRuns(std::move(seen));
    moved.first_frame = point.first_frame + by.frame;
    moved.last_frame = point.last_frame + by.frame;
  }
  for (const auto& [id, target] : b.aliases) a.aliases[id + by.instance] = target + by.instance;
  for (const auto& [pair, count] : b.pair_counts)
    a.pair_counts[{pair.first + by.label, pair.second + by.label}] = count;
  for (const auto& [label, seen] : b.entity_sightings)
    for (const EntitySighting& sighting : seen)
      a.entity_sightings[label + by.label].push_back(
          {sighting.frame + by.mask_frame, sighting.entity, sighting.rating});
  a.frames += b.frames;
  a.last_id = by.instance + highest_b;
}

void append_looks(MapRecord& map_a, const MapRecord& map_b, const Pose& a_from_b,
                  const Offsets& by) {
  SemanticRecord& a = map_a.semantics;
  const SemanticRecord& b = map_b.semantics;
  if (a.encoder.name.empty()) a.encoder = b.encoder;
  if (a.writing_reader.empty()) a.writing_reader = b.writing_reader;
  if (a.recognizer.name.empty()) a.recognizer = b.recognizer;
  const bool same_things = a.recognizer == b.recognizer;
  const Eigen::Isometry3f pose = a_from_b.cast<float>();
  // Directions are those of the old frame and grid: what was seen counts again from nothing.
  const bool others = !pose.linear().isIdentity(1e-4f) ||
                      a.views.grid(map_a.depth_camera) != b.views.grid(map_b.depth_camera);
  for (const auto& [label, look] : b.looks) {
    SuperPointLook moved = look;
    if (!moved.seen_in_world.isEmpty()) moved.seen_in_world.transform(pose);
    for (ObjectView& view : moved.views) {
      view.frame += by.frame;
      if (!same_things) view.things.resize(0);  // other numbers mean other things
      view.super_point += by.label;
      view.directions.center_in_world = pose * view.directions.center_in_world;
      if (others) view.directions.bins = {};
    }
    a.looks[label + by.label] = std::move(moved);
  }
}

void append_frames(MapRecord& a, const MapRecord& b, const Pose& a_from_b, const Offsets& by) {
  for (FrameLogEntry frame : b.frames) {
    frame.index += by.frame;
    frame.world_from_camera = a_from_b * frame.world_from_camera;
    a.frames.push_back(std::move(frame));
  }
  a.mask_frames += b.mask_frames;
  if (!b.source.empty() && b.source != a.source)
    a.source += (a.source.empty() ? "" : " + ") + b.source;
}

/// A map of which only a part could be fused again keeps nothing. Call before append_frames.
void append_kept_frames(MapRecord& a, const MapRecord& b, const Offsets& by) {
  if (a.kept_frames.empty() || b.kept_frames.empty() || a.depth_camera != b.depth_camera) {
    a.kept_frames.clear();
    return;
  }
  for (const auto& [position, kept] : b.kept_frames) {
    auto frame = std::make_shared<KeptFrame>(*kept);
    for (Label& label : frame->labels) label += label == kNoLabel ? 0 : by.label;
    a.kept_frames[a.frames.size() + position] = std::move(frame);
  }
}

void append_edits(MapEdits& a, const MapEdits& b, const Offsets& by) {
  for (MapEdit edit : b) {
    edit.id += by.edit;
    for (InstanceId& id : edit.instances) id += by.instance;
    for (Label& label : edit.super_points) label += by.label;
    if (edit.new_instance != 0) edit.new_instance += by.instance;
    if (edit.undoes != 0) edit.undoes += by.edit;
    a.push_back(std::move(edit));
  }
  mark_undone(a);
}

/// Objects as the fused voxels show them. What lost all its surface to others is gone.
void append_instances(MapDocument& a, const MapRecord& b, const Offsets& by) {
  for (InstanceSummary instance : b.instances) {
    instance.id += by.instance;
    for (Label& label : instance.super_points) label += by.label;
    a.instances.push_back(std::move(instance));
  }
  const SurfaceExtents extents = surface_extents(a.map);
  measure_instances(extents, a.instances);
  std::erase_if(a.instances, [](const InstanceSummary& instance) { return instance.points == 0; });
  for (const auto& [id, name] : b.names) a.names[id + by.instance] = name;
  a.surfaces = surfaces_and_boxes(a.map, a.instances);
  a.parts = find_parts(extents, a.instances, a.registry.entity_sightings, InstanceSummaryConfig{});
}

MapRecord corrected(const MapDocument& map) {
  MapRecord record = map;
  apply_edits(record, map.map.labels(), [&]() -> const VoxelMap& { return map.map; });
  return record;
}

/// Which objects of two corrected maps are one.
class Matchmaker {
 public:
  Matchmaker(const MapRecord& a, const MapRecord& b, const Pose& a_from_b,
             const MapMergeConfig& config, InstanceId offset)
      : a_(a), b_(b), config_(config), offset_(offset) {
    for (const auto& [pair, overlap] : overlaps(a, b, a_from_b, config.tolerance_m))
      consider(pair.first, pair.second, overlap);
    std::stable_sort(
        candidates_.begin(), candidates_.end(),
        [](const MergedPair& x, const MergedPair& y) { return x.overlap > y.overlap; });
  }

  /// Takes the best pairs first, one partner each.
  void match(std::vector<MergedPair>& pairs, std::vector<MergeConflict>& conflicts) const {
    std::map<InstanceId, InstanceId> partner;  // either way, ids of b moved
    for (const MergedPair& pair : candidates_) {
      const auto taken = partner.count(pair.a) ? pair.a : pair.b;
      if (partner.contains(taken)) {
        conflicts.push_back({pair.a, pair.b,
                             concat("they overlap by ", percent_text(pair.overlap), ", but object ",
                                    taken, " is one with ", partner.at(taken), " already")});
        continue;
      }
      if (const std::string why = refusal(pair); !why.empty()) {
        conflicts.push_back({pair.a, pair.b, why});
        continue;
      }
      partner[pair.a] = pair.b;
      partner[pair.b] = pair.a;
      pairs.push_back(pair);
      if (const auto [mine, theirs] = names(pair);
          !mine.empty() && !theirs.empty() && mine != theirs)
        conflicts.push_back(
            {pair.a, pair.b,
             concat("one is called '", mine, "', the other '", theirs, "'; the first name stays")});
    }
  }

 private:
  void consider(InstanceId a, InstanceId b, const ObjectOverlap& overlap) {
    const auto cosine = look_similarity(a_, a, b_, b);
    const bool part = std::max(overlap.share_a, overlap.share_b) >= config_.same_share;
    const bool alike = cosine && *cosine >= config_.alike;
    const bool same_in_common = overlap.common_iou >= config_.same_common_iou &&
                                overlap.shared_points >= static_cast<float>(config_.common_points);
    if (overlap.iou >= config_.same_iou || same_in_common || (part && alike))
      candidates_.push_back({a, b + offset_, overlap.iou, cosine});
  }

  std::string refusal(const MergedPair& pair) const {
    if (a_.locked.contains(pair.a) || b_.locked.contains(pair.b - offset_))
      return concat("they overlap by ", percent_text(pair.overlap), ", but one is locked");
    if (pair.cosine && *pair.cosine < config_.unlike)
      return concat("they overlap by ", percent_text(pair.overlap), ", but look different (cosine ",
                    percent_text(*pair.cosine), ")");
    return {};
  }

  std::pair<std::string, std::string> names(const MergedPair& pair) const {
    const auto mine = a_.names.find(pair.a), theirs = b_.names.find(pair.b - offset_);
    return {mine == a_.names.end() ? "" : mine->second,
            theirs == b_.names.end() ? "" : theirs->second};
  }

  const MapRecord &a_, &b_;
  const MapMergeConfig& config_;
  InstanceId offset_;
  std::vector<MergedPair> candidates_;
};

void log_pairs(const std::vector<MergedPair>& pairs, MapEdits& log) {
  const double now =
      std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
  for (const MergedPair& pair : pairs) {
    MapEdit edit;
    edit.action = EditAction::kMerge;
    edit.instances = {pair.a, pair.b};
    edit.note = "maps merged";
    edit.id = log.empty() ? 1 : log.back().id + 1;
    edit.time_s = now;
    log.push_back(std::move(edit));
  }
}

void require_one_encoder(const SemanticRecord& a, const SemanticRecord& b) {
  if (a.encoder.name.empty() || b.encoder.name.empty() || a.encoder == b.encoder) return;
  throw Error(concat("the maps have embeddings of different encoders, '", a.encoder.name, "' and '",
                     b.encoder.name, "'; give one of them the other's with `ovimap reembed`"));
}

}  // namespace

void list_fields(MapMergeConfig& config, ConfigFields& fields) {
  fields.add("tolerance_m", config.tolerance_m, 0.001f, 1.f,
             "surfaces nearer to each other are at the same place, metres");
  fields.add("same_iou", config.same_iou, 0.f, 1.f, "overlap at which two objects are one");
  fields.add("same_common_iou", config.same_common_iou, 0.f, 1.f,
             "or where both maps have surface, if they share enough of it");
  fields.add("common_points", config.common_points, 1, 1000000,
             "how much that is, in points 2 cm apart");
  fields.add("same_share", config.same_share, 0.f, 1.f, "or of either one's points, if alike");
  fields.add("alike", config.alike, -1.f, 1.f, "cosine at which looks agree");
  fields.add("unlike", config.unlike, -1.f, 1.f, "cosine below which they speak against it");
}

MapMerge merge_maps(MapDocument a, const MapDocument& b, const Pose& a_from_b,
                    const MapMergeConfig& config) {
  require_one_encoder(a.semantics, b.semantics);
  MapMerge result;
  const Offsets by = offsets_after(a, a.map.labels().last_label());
  const MapRecord seen_a = corrected(a), seen_b = corrected(b);
  Matchmaker(seen_a, seen_b, a_from_b, config, by.instance).match(result.pairs, result.conflicts);
  fuse_map(a.map, b.map, a_from_b, append_labels(a.map, b.map.labels()));
  append_registry(a.registry, b.registry, by, highest_id(b));
  append_looks(a, b, a_from_b, by);
  append_kept_frames(a, b, by);
  append_frames(a, b, a_from_b, by);
  append_instances(a, b, by);
  append_edits(a.edits, b.edits, by);
  log_pairs(result.pairs, a.edits);
  a.timings.clear();
  a.live_steps.clear();  // they made a part of it
  a.history = {};        // likewise, and tells of a part
  result.map = std::move(a);
  return result;
}

}  // namespace ovimap
