// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/evaluation/change_evaluation.h"

#include <algorithm>
#include <set>

#include "ovimap/base/config.h"
#include "ovimap/base/error.h"
#include "ovimap/eval/geometry/nearest.h"
#include "ovimap/frames/frame/frame_source.h"
#include "ovimap/geometry/box_overlap.h"
#include "ovimap/io/truth/truth.h"
#include "ovimap/io/truth/truth_changes.h"
#include "ovimap/map/surface/mesh_extraction.h"
#include "ovimap/pipeline/evaluation/knowable_changes.h"
#include "ovimap/pipeline/evaluation/looked_through.h"

namespace ovimap {

namespace {

Points keep_those_apart(const Points& points, const NearestPoints& from, float distance_m) {
  const auto near = from.find_all(points, distance_m);
  Points apart;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!near[i]) apart.push_back(points[i]);
  return apart;
}

std::size_t count_near(const Points& points, const NearestPoints& surface, float distance_m) {
  const auto near = surface.find_all(points, distance_m);
  return static_cast<std::size_t>(
      std::count_if(near.begin(), near.end(), [](const auto& found) { return found.has_value(); }));
}

/// Where a thing is in neither, both agree.
float box_overlap(const Eigen::AlignedBox3f& a, const Eigen::AlignedBox3f& b) {
  return a.isEmpty() && b.isEmpty() ? 1.f : overlap(a, b);
}

/// One event for each change, the best first come, told while the thing was as the change left it:
/// in the visit before which it changed, or one up to `last`.
class EventMatcher {
 public:
  EventMatcher(const std::vector<ObjectEvent>& events, const ChangeScoresConfig& config)
      : events_(events), used_(events.size(), false), config_(config) {}

  const ObjectEvent* match(const TrueChange& change, int last) {
    std::size_t best = events_.size();
    float best_overlap = config_.same_place;
    for (std::size_t i = 0; i < events_.size(); ++i) {
      if (used_[i] || !told_in_time(events_[i], change, last) ||
          name_of(events_[i].kind) != change.kind)
        continue;
      const float overlap = std::min(box_overlap(events_[i].before, change.from),
                                     box_overlap(events_[i].after, change.to));
      if (overlap >= best_overlap) best = i, best_overlap = overlap;
    }
    if (best == events_.size()) return nullptr;
    used_[best] = true;
    return &events_[best];
  }

  /// Whether one event says that the thing is gone and another that it may be at its new place.
  bool tells_in_doubt(const TrueChange& change, int last) const {
    return std::any_of(events_.begin(), events_.end(), [&](const ObjectEvent& event) {
      return told_in_time(event, change, last) && event.may_be != 0 &&
             box_overlap(event.after, change.to) >= config_.same_place &&
             std::any_of(events_.begin(), events_.end(), [&](const ObjectEvent& gone) {
               return gone.visit == event.visit && gone.kind == ObjectEventKind::kGone &&
                      box_overlap(gone.before, change.from) >= config_.same_place;
             });
    });
  }

  /// Events that nothing matched and that were told without doubt.
  std::vector<ObjectEvent> wrong() const {
    std::vector<ObjectEvent> wrong;
    for (std::size_t i = 0; i < events_.size(); ++i)
      if (!used_[i] && !doubtful(events_[i])) wrong.push_back(events_[i]);
    return wrong;
  }

  static std::string name_of(ObjectEventKind kind) {
    return kind == ObjectEventKind::kMoved  ? "moved"
           : kind == ObjectEventKind::kGone ? "removed"
                                            : "added";
  }

 private:
  static bool told_in_time(const ObjectEvent& event, const TrueChange& change, int last) {
    return event.visit >= change.visit && event.visit <= last;
  }

  bool doubtful(const ObjectEvent& event) const {
    return event.may_be != 0 ||
           std::any_of(events_.begin(), events_.end(), [&](const ObjectEvent& other) {
             return other.visit == event.visit && other.may_be == event.instance;
           });
  }

  const std::vector<ObjectEvent>& events_;
  std::vector<bool> used_;
  const ChangeScoresConfig& config_;
};

ChangeCounts& counts_of(const std::string& kind, ChangeScores& scores) {
  return kind == "moved" ? scores.moved : kind == "removed" ? scores.removed : scores.added;
}

void score_events(const MapHistory& history, const TrueChanges& truth,
                  const std::vector<Truth>& visits, const ChangeScoresConfig& config,
                  ChangeScores& scores) {
  EventMatcher matcher(history.events, config);
  const KnowableChanges knowable(truth, visits, config);
  const auto score = [&](const TrueChange& change, bool told, bool real) {
    ChangeCounts& counts = counts_of(change.kind, scores);
    counts.real += real;
    counts.right += told;
    counts.told += told;
  };
  std::vector<TrueChange> untold;
  for (const TrueChange& change : truth.changes)
    if (matcher.match(change, knowable.until(change)))
      score(change, true, true), scores.ids_kept += change.kind == "moved";
    else
      untold.push_back(change);
  for (const TrueChange& change : untold) {
    const int last = knowable.until(change);
    scores.in_doubt += change.kind == "moved" && matcher.tells_in_doubt(change, last);
    for (const auto& [known, real] : knowable.as_known(change)) {
      const bool told = matcher.match(known, last) != nullptr;
      score(known, told, told || real);
    }
  }
  for (const ObjectEvent& event : matcher.wrong())
    ++counts_of(EventMatcher::name_of(event.kind), scores).told;
}

/// Where things were that are there no more, as the visit before saw them.
Points places_left(const TrueChanges& truth, const std::vector<Truth>& visits, int visit) {
  std::set<std::int32_t> left;
  for (const TrueChange& change : truth.changes)
    if (change.visit == visit && !change.from.isEmpty()) left.insert(change.object);
  return points_of(visits[static_cast<std::size_t>(visit - 2)], left);
}

void score_surface(const Points& surface, const TrueChanges& truth,
                   const std::vector<Truth>& visits, const ChangeScoresConfig& config,
                   ChangeScores& scores) {
  const NearestPoints map(surface), now(visits.back().mesh.vertices);
  const int last = static_cast<int>(visits.size());
  std::set<std::int32_t> changed;
  for (const TrueChange& change : truth.changes) changed.insert(change.object);
  for (int visit = 2; visit <= last; ++visit) {
    const Points left = keep_those_apart(places_left(truth, visits, visit), now, config.apart_m);
    LookedThrough looked(left, config.through_m);
    for (int later = visit; later <= last; ++later)
      looked.add(*open_frame_source(truth.visits[static_cast<std::size_t>(later - 1)], {}));
    const Points counted = looked.at_least(config.frames);
    scores.left_points += counted.size();
    scores.ghost_points += count_near(counted, map, config.near_m);
  }
  const Points unchanged = points_of(visits.back(), changed, true);
  scores.static_points = unchanged.size();
  scores.kept_points = count_near(unchanged, map, config.near_m);
}

/// Points of the frame's surface that belong to some instances, one in each cell.
Points shown_points(const Frame& frame, const IdImage& ids, const std::set<std::int32_t>& objects,
                    float cell_m) {
  Points points;
  std::set<std::array<int, 3>> cells;
  const Eigen::Isometry3f world_from_camera = frame.world_from_camera.cast<float>();
  for (int y = 0; y < frame.depth.height(); ++y)
    for (int x = 0; x < frame.depth.width(); ++x) {
      if (frame.depth.at(x, y) <= 0.f || !objects.contains(ids.at(x, y))) continue;
      const Eigen::Vector3f point =
          world_from_camera * frame.depth_camera.unproject(static_cast<float>(x),
                                                           static_cast<float>(y),
                                                           frame.depth.at(x, y));
      const Eigen::Vector3i cell = (point / cell_m).array().floor().cast<int>();
      if (cells.insert({cell.x(), cell.y(), cell.z()}).second) points.push_back(point);
    }
  return points;
}

/// Frame by frame: how much of what moved then is still in the map.
void score_movers(const Points& surface, const TrueChanges& truth, const std::vector<Truth>& visits,
                  const ChangeScoresConfig& config, ChangeScores& scores) {
  const NearestPoints map(surface);
  for (std::size_t i = 0; i < visits.size(); ++i) {
    std::set<std::int32_t> moving;
    for (const TrueMover& mover : truth.moving)
      if (mover.visit == static_cast<int>(i) + 1) moving.insert(mover.object);
    if (moving.empty()) continue;
    const NearestPoints stands(visits[i].mesh.vertices), now(visits.back().mesh.vertices);
    const auto source = open_frame_source(truth.visits[i], {});
    Points all;
    for (std::int64_t position = 0; position < source->size(); ++position) {
      const FrameRead read = source->read(position);
      const auto ids = source->truth_ids(position);
      if (!read.frame || !ids || !ids->same_size(read.frame->depth)) continue;
      const Points shown = keep_those_apart(
          keep_those_apart(shown_points(*read.frame, *ids, moving, config.mover_cell_m), stands,
                           config.apart_m),
          now, config.apart_m);
      all.insert(all.end(), shown.begin(), shown.end());
    }
    LookedThrough looked(all, config.through_m);
    looked.add(*source);
    scores.knowable_points += looked.count(config.frames);
    scores.mover_points += all.size();
    scores.mover_left += count_near(all, map, config.near_m);
  }
}

}  // namespace

void list_fields(ChangeScoresConfig& config, ConfigFields& fields) {
  fields.add("near_m", config.near_m, 0.001f, 1.f,
             "surface of the map this near to a point is there, metres");
  fields.add("apart_m", config.apart_m, 0.f, 1.f,
             "places that were left count where nothing stands this near now, metres");
  fields.add("frames", config.frames, 1, 1000, "and where so many frames looked through");
  fields.add("through_m", config.through_m, 0.f, 1.f, "by this much, metres");
  fields.add("mover_cell_m", config.mover_cell_m, 0.001f, 1.f,
             "of what moves one point in each such cube counts, metres");
  fields.add("seen_frames", config.seen_frames, 1, 100000,
             "things count as changed that so many frames of each visit show");
  fields.add("seen_px", config.seen_px, 1, 1000000, "by at least so many pixels");
  fields.add("seen_share", config.seen_share, 0.f, 1.f,
             "and whose places, before and after, the other visit has in sight by this share");
  fields.add("same_place", config.same_place, 0.f, 1.f,
             "intersection over union of boxes that are of one thing");
}

ChangeScores score_changes(const MapDocument& map, const std::filesystem::path& folder,
                           const ChangeScoresConfig& config) {
  const TrueChanges truth = load_true_changes(folder);
  const std::size_t visits = std::max<std::size_t>(map.history.visits.size(), 1);
  if (visits != truth.visits.size())
    throw Error(concat("the map is of ", visits, " visits, and ", folder.string(), " has ",
                       truth.visits.size(),
                       "; go on with it by `ovimap run VISIT --continue MAP`"));
  std::vector<Truth> truths;
  for (const auto& visit : truth.visits) truths.push_back(load_truth(visit));
  ChangeScores scores;
  const Points surface = extract_mesh(map.map).vertices;
  score_surface(surface, truth, truths, config, scores);
  score_movers(surface, truth, truths, config, scores);
  score_events(map.history, truth, truths, config, scores);
  return scores;
}

}  // namespace ovimap
