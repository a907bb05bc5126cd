// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/revise/map_diff.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "ovimap/base/config.h"
#include "ovimap/base/parallel.h"
#include "ovimap/map/rays/surface_lookup.h"
#include "ovimap/pipeline/alignment/object_layout.h"
#include "ovimap/pipeline/revise/object_overlap.h"
#include "ovimap/pipeline/revise/percent_text.h"

namespace ovimap {

namespace {

// Then maps may make room. A floor alone leads to most of a flat's voxels.
constexpr std::size_t kObjectsPerPart = 32, kPointsPerPart = 10000;

std::vector<Pose> camera_poses(const MapRecord& map) {
  std::vector<Pose> poses;
  for (const FrameLogEntry& frame : map.frames) poses.push_back(frame.world_from_camera);
  return poses;
}

/// What one map knows of a place of the other.
class Witness {
 public:
  Witness(const MapDocument& map, const Pose& map_from_other, const MapDiffConfig& config)
      : map_(map),
        map_from_other_(map_from_other.cast<float>()),
        config_(config),
        space_(map.map, map.depth_camera, camera_poses(map), config.space) {}

  /// Fills the evidence about an object of the other map.
  void testify(const std::vector<Eigen::Vector3f>& surface, ObjectChange& change) const {
    if (surface.empty()) return;
    VoxelFinder finder(map_.map);
    std::size_t through = 0, there = 0;
    Eigen::AlignedBox3f box;
    for (const Eigen::Vector3f& other : surface) box.extend(map_from_other_ * other);
    const auto views = space_.views_into(box.center(), 0.5f * box.diagonal().norm());
    for (const Eigen::Vector3f& other : surface) {
      const Eigen::Vector3f point = map_from_other_ * other;
      if (is_surface(finder, point))
        ++there;
      else if (space_.seen_through(point, views, config_.gone_views) >= config_.gone_views)
        ++through;
    }
    const auto count = static_cast<float>(surface.size());
    change.seen_through = static_cast<float>(through) / count;
    change.surface_there = static_cast<float>(there) / count;
  }

 private:
  bool is_surface(VoxelFinder& finder, const Eigen::Vector3f& point) const {
    if (!finder.seek(point)) return false;
    return finder.block().weight[static_cast<std::size_t>(finder.voxel())] > 0.f &&
           std::fabs(finder.distance_m()) <= config_.tolerance_m;
  }

  const MapDocument& map_;
  Eigen::Isometry3f map_from_other_;
  const MapDiffConfig& config_;
  ObservedSpace space_;
};

const std::vector<Eigen::Vector3f>& surface_of(const MapRecord& map, InstanceId id) {
  static const std::vector<Eigen::Vector3f> kNone;
  const auto found = map.surfaces.find(id);
  return found == map.surfaces.end() ? kNone : found->second;
}

std::string metres(float value) {
  char text[24];
  std::snprintf(text, sizeof text, "%.2f m", double{value});
  return text;
}

/// Compares two maps object by object.
class MapComparison {
 public:
  MapComparison(const MapDocument& before, const MapDocument& after, const Pose& before_from_after,
                const MapDiffConfig& config)
      : before_(before),
        after_(after),
        before_from_after_(before_from_after),
        config_(config),
        overlaps_(overlaps(before, after, before_from_after, config.tolerance_m)) {}

  std::vector<ObjectChange> changes() {
    list_objects();
    judge_places();
    match_moved();
    for (ObjectChange& change : changes_) explain(change);
    return std::move(changes_);
  }

 private:
  /// Pairs objects that lie at the same place; what has no partner stands alone.
  void list_objects() {
    std::set<InstanceId> found;
    for (const InstanceSummary& instance : before_.instances) {
      ObjectChange& change = changes_.emplace_back();
      change.before = instance.id;
      for (const auto& [pair, overlap] : overlaps_) {
        if (pair.first != instance.id) continue;
        if (overlap.iou >= config_.same_iou ||
            std::max(overlap.share_a, overlap.share_b) >= config_.same_share) {
          found.insert(pair.second);
          if (overlap.iou > change.overlap)
            change.after = pair.second, change.overlap = overlap.iou;
        }
      }
    }
    for (const InstanceSummary& instance : after_.instances)
      if (!found.contains(instance.id)) changes_.emplace_back().after = instance.id;
  }

  void judge_places() {
    const Witness later(after_, before_from_after_.inverse(), config_),
        earlier(before_, before_from_after_, config_);
    std::vector<float> arrived(changes_.size(), 0.f);
    const auto judge = [&](std::size_t i) {
      ObjectChange& change = changes_[i];
      if (change.before != 0)
        later.testify(surface_of(before_, change.before), change);
      else
        earlier.testify(surface_of(after_, change.after), change);
      if (change.before != 0 && change.after != 0) {
        arrived[i] = judge_shift(earlier, change);
        return;
      }
      if (is_away(change, config_))
        change.kind = change.before != 0 ? ChangeKind::kRemoved : ChangeKind::kNew;
      else
        change.kind =
            change.surface_there >= config_.gone_share ? ChangeKind::kSame : ChangeKind::kUnseen;
    };
    for (std::size_t first = 0, end = 0; first < changes_.size(); first = end) {
      end = end_of_part(first);
      parallel_for(end - first, 1, [&](std::size_t i) { judge(first + i); });
      before_.map.trim();
      after_.map.trim();
    }
    part_from_remains(arrived);
  }

  std::size_t end_of_part(std::size_t first) const {
    std::size_t end = first, points = 0;
    while (end < changes_.size() && end - first < kObjectsPerPart && points < kPointsPerPart) {
      points += surface_of(before_, changes_[end].before).size() +
                surface_of(after_, changes_[end].after).size();
      ++end;
    }
    return end;
  }

  /// What came to where remains of another thing lie is an object of its own: the two share hardly
  /// any of their surface, and most of it is where nothing was.
  bool is_other(const ObjectChange& change, float arrived) const {
    return change.overlap < config_.same_iou && arrived >= config_.gone_share;
  }

  void part_from_remains(const std::vector<float>& arrived) {
    for (std::size_t i = 0; i < arrived.size(); ++i) {
      ObjectChange& change = changes_[i];
      if (change.before == 0 || change.after == 0 || !is_other(change, arrived[i])) continue;
      ObjectChange come = part_arrival(change);
      come.seen_through = arrived[i];
      if (is_away(change, config_)) change.kind = ChangeKind::kRemoved;
      changes_.push_back(come);
    }
  }

  /// An object that overlaps with itself but left a part of its place, and came to a new part.
  /// Returns the share of where it is now that the earlier map saw through.
  float judge_shift(const Witness& earlier, ObjectChange& change) const {
    change.cosine = look_similarity(before_, change.before, after_, change.after);
    ObjectChange arrived;
    earlier.testify(surface_of(after_, change.after), arrived);
    if (!is_other(change, arrived.seen_through) && change.seen_through >= config_.shift_share &&
        arrived.seen_through >= config_.shift_share) {
      change.kind = ChangeKind::kMoved;
      change.shift_m = shift(change.before, change.after);
    }
    return arrived.seen_through;
  }

  Eigen::Vector3f shift(InstanceId before, InstanceId after) const {
    return before_from_after_.cast<float>() * find_instance(after_.instances, after)->centroid -
           find_instance(before_.instances, before)->centroid;
  }

  /// What went from one place and came to another is one thing when it looks alike; the most alike
  /// first.
  void match_moved() {
    struct Candidate {
      float cosine;
      std::size_t gone, come;
    };
    std::vector<Candidate> candidates;
    for (std::size_t i = 0; i < changes_.size(); ++i)
      for (std::size_t j = 0; j < changes_.size(); ++j) {
        if (changes_[i].kind != ChangeKind::kRemoved || changes_[j].kind != ChangeKind::kNew)
          continue;
        const auto cosine = look_similarity(before_, changes_[i].before, after_, changes_[j].after);
        const float size = size_similarity(*find_instance(before_.instances, changes_[i].before),
                                           *find_instance(after_.instances, changes_[j].after));
        if (cosine && *cosine >= config_.moved_cosine && size >= config_.moved_size &&
            stands_out(changes_[i].before, changes_[j].after, *cosine))
          candidates.push_back({*cosine, i, j});
      }
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Candidate& a, const Candidate& b) { return a.cosine > b.cosine; });
    std::set<std::size_t> used;
    for (const Candidate& candidate : candidates) {
      if (used.contains(candidate.gone) || used.contains(candidate.come)) continue;
      used.insert({candidate.gone, candidate.come});
      ObjectChange& change = changes_[candidate.gone];
      change.kind = ChangeKind::kMoved;
      change.after = changes_[candidate.come].after;
      change.cosine = candidate.cosine;
      change.shift_m = shift(change.before, change.after);
      changes_[candidate.come].after = 0;  // told with where it went from
    }
    std::erase_if(changes_, [](const ObjectChange& c) { return c.before == 0 && c.after == 0; });
  }

  /// How alike is alike depends on the encoder, so the others are the measure.
  bool stands_out(InstanceId before, InstanceId after, float cosine) const {
    const auto more_alike = [&](const MapRecord& others, const auto& likeness) {
      std::size_t better = 0, known = 0;
      for (const InstanceSummary& other : others.instances)
        if (const std::optional<float> value = likeness(other.id)) {
          ++known;
          better += *value > cosine;
        }
      return static_cast<float>(better) / static_cast<float>(std::max<std::size_t>(known, 1));
    };
    return more_alike(after_,
                      [&](InstanceId other) {
                        return look_similarity(before_, before, after_, other);
                      }) <= config_.moved_rank &&
           more_alike(before_, [&](InstanceId other) {
             return look_similarity(before_, other, after_, after);
           }) <= config_.moved_rank;
  }

  static void explain(ObjectChange& change) {
    const std::string through = percent_text(change.seen_through),
                      there = percent_text(change.surface_there);
    const std::string look = change.cosine ? concat(", looks alike with a cosine of ",
                                                    metres(*change.cosine).substr(0, 4))
                                           : "";
    switch (change.kind) {
      case ChangeKind::kSame:
        change.evidence =
            change.before != 0 && change.after != 0
                ? concat("overlap ", percent_text(change.overlap), look)
                : concat("surface at ", there, " of its place, as part of other things");
        return;
      case ChangeKind::kMoved:
        change.evidence =
            concat("by ", metres(change.shift_m.norm()), "; the later map saw through ", through,
                   " of its old place", look);
        return;
      case ChangeKind::kRemoved:
        change.evidence = concat("the later map saw through ", through, " of its place");
        return;
      case ChangeKind::kNew:
        change.evidence = concat("the earlier map saw through ", through, " of its place");
        return;
      case ChangeKind::kUnseen:
        change.evidence = concat("the other map saw through ", through,
                                 " of its place and has surface "
                                 "at ",
                                 there);
        return;
    }
  }

  const MapDocument &before_, &after_;
  Pose before_from_after_;
  const MapDiffConfig& config_;
  ObjectOverlaps overlaps_;
  std::vector<ObjectChange> changes_;
};

}  // namespace

void list_fields(MapDiffConfig& config, ConfigFields& fields) {
  fields.add("tolerance_m", config.tolerance_m, 0.001f, 1.f,
             "surfaces nearer to each other are at the same place, metres");
  fields.add("same_iou", config.same_iou, 0.f, 1.f, "overlap at which two objects are one");
  fields.add("same_share", config.same_share, 0.f, 1.f, "of an object's points: it is the same");
  fields.add("gone_share", config.gone_share, 0.f, 1.f, "of points seen through: it is gone");
  fields.add("shift_share", config.shift_share, 0.f, 1.f, "of points seen through: it moved");
  fields.add("gone_views", config.gone_views, 1, 1000, "cameras that must see through a point");
  fields.add("moved_cosine", config.moved_cosine, -1.f, 1.f, "least likeness of a moved thing");
  fields.add("moved_rank", config.moved_rank, 0.f, 1.f, "of other objects that look more like it");
  fields.add("moved_size", config.moved_size, 0.f, 1.f, "least likeness of its size");
  fields.group("space", [&](ConfigFields& space) { list_fields(config.space, space); });
}

const char* change_name(ChangeKind kind) {
  constexpr std::array kNames = {"same", "moved", "removed", "new", "unseen"};
  return kNames[static_cast<std::size_t>(kind)];
}

bool is_away(const ObjectChange& change, const MapDiffConfig& config) {
  return change.seen_through >= config.shift_share &&
         change.seen_through >= config.gone_share * (1.f - change.surface_there);
}

ObjectChange part_arrival(ObjectChange& change) {
  ObjectChange come;
  come.kind = ChangeKind::kNew;
  come.after = std::exchange(change.after, 0);
  return come;
}

std::vector<ObjectChange> diff_maps(const MapDocument& before, const MapDocument& after,
                                    const Pose& before_from_after, const MapDiffConfig& config) {
  return MapComparison(before, after, before_from_after, config).changes();
}

}  // namespace ovimap
