// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/track/graph/loop_closure.h"

#include <algorithm>

#include "ovimap/base/config.h"
#include "ovimap/track/places/place_view.h"

namespace ovimap {

namespace {

struct Candidate {
  double rank = 0;  ///< smaller first
  std::size_t place = 0;
};

/// Earlier keyframes that may show what keyframe `at` shows.
std::vector<Candidate> candidates_of(std::size_t at, const std::vector<Keyframe>& keyframes,
                                     const std::vector<double>& paths, const LoopConfig& config) {
  std::vector<Candidate> found;
  for (std::size_t i = 0; i < at; ++i) {
    const double path = paths[at] - paths[i];
    if (path < config.min_path_m) break;
    const double alike = similarity(keyframes[at].code, keyframes[i].code);
    const Pose between = keyframes[i].world_from_camera.inverse() * keyframes[at].world_from_camera;
    const bool near = between.translation().norm() < config.near_m + config.drift_per_m * path &&
                      Eigen::AngleAxisd(between.linear()).angle() < 0.6;
    if (alike >= config.min_similarity || (near && alike > 0)) found.push_back({-alike, i});
  }
  std::sort(found.begin(), found.end(), [](const Candidate& a, const Candidate& b) {
    return std::tie(a.rank, a.place) < std::tie(b.rank, b.place);
  });
  if (std::ssize(found) > config.candidates)
    found.resize(static_cast<std::size_t>(config.candidates));
  return found;
}

/// The pair's edge when its frames show one place.
std::optional<PoseEdge> verified(const Keyframe& earlier, const Keyframe& later,
                                 const TrackConfig& track) {
  const TrackPyramid place = pyramid_of(earlier), frame = pyramid_of(later);
  const Reference reference = make_reference(place, {}, Pose::Identity());
  const std::vector<Pose> starts = {earlier.world_from_camera.inverse() * later.world_from_camera,
                                    turn_between(place, frame), Pose::Identity()};
  const std::optional<Alignment> alignment = align_best(reference, frame, starts, track.alignment);
  if (!alignment || !believable(alignment->quality, track, true) || alignment->degenerate > 0)
    return std::nullopt;
  PoseEdge edge;
  edge.from_to = alignment->reference_from_frame;
  edge.loop = true;
  return edge;
}

/// The keyframe that was nearest to keyframe `at` before the camera came back to it; nullopt: none
/// was as near as the drift makes possible.
std::optional<std::size_t> nearest_place(std::size_t at, const std::vector<Keyframe>& keyframes,
                                         const std::vector<double>& paths,
                                         const LoopConfig& config) {
  std::optional<std::size_t> nearest;
  double least = 0;
  for (std::size_t i = 0; i < at && paths[at] - paths[i] >= config.min_path_m; ++i) {
    const Pose &place = keyframes[i].world_from_camera, &here = keyframes[at].world_from_camera;
    const double off_m = (place.inverse() * here).translation().norm();
    if (off_m > config.near_m + config.drift_per_m * (paths[at] - paths[i])) continue;
    const double rank = place_distance(place, here);
    if (!nearest || rank < least) nearest = i, least = rank;
  }
  return nearest;
}

/// The keyframes of the way through a place, old ones alone: they agree with each other.
std::span<const Keyframe> way_through(std::size_t place, std::size_t at,
                                      const std::vector<Keyframe>& keyframes,
                                      const std::vector<double>& paths, const LoopConfig& config) {
  std::size_t first = place, end = place + 1;
  while (first > 0 && paths[place] - paths[first - 1] <= config.way_m) --first;
  while (end < at && paths[end] - paths[place] <= config.way_m &&
         paths[at] - paths[end] >= config.min_path_m)
    ++end;
  return std::span(keyframes).subspan(first, end - first);
}

/// The edge to `place` when keyframe `later` shows what the keyframes on the way through it show
/// from where it seems to be.
std::optional<PoseEdge> verified(std::span<const Keyframe> way, const Keyframe& place,
                                 const Keyframe& later, const TrackConfig& track) {
  Keyframe seen{later.index, later.world_from_camera, {}, {}};
  seen.image = place_view(way, later.image.camera, later.world_from_camera);
  std::optional<PoseEdge> edge = verified(seen, later, track);
  if (edge)
    edge->from_to = place.world_from_camera.inverse() * later.world_from_camera * edge->from_to;
  return edge;
}

}  // namespace

void list_fields(LoopConfig& config, ConfigFields& fields) {
  fields.add("min_path_m", config.min_path_m, 0.f, 1e6f,
             "a loop is a place seen again after so long a way, metres");
  fields.add("candidates", config.candidates, 1, 1000, "places that a keyframe is held against");
  fields.add("min_similarity", config.min_similarity, -1.f, 1.f,
             "least similarity of the codes of two places to be held against each other");
  fields.add("near_m", config.near_m, 0.f, 1000.f,
             "keyframes so near each other are held against each other as well, metres");
  fields.add("drift_per_m", config.drift_per_m, 0.f, 1.f,
             "and by this much farther ones for each metre of way between them");
  fields.add("way_m", config.way_m, 0.f, 1000.f,
             "keyframes of so much way to either side of a place show it together, metres");
  fields.add("step_sigma_m", config.step_sigma_m, 1e-5f, 10.f,
             "standard deviation of the motion between two keyframes, metres");
  fields.add("step_sigma_rad", config.step_sigma_rad, 1e-5f, 10.f,
             "standard deviation of the turn between two keyframes, radians");
  fields.add("loop_sigma_m", config.loop_sigma_m, 1e-5f, 10.f,
             "standard deviation of a place seen again, metres");
  fields.add("loop_sigma_rad", config.loop_sigma_rad, 1e-5f, 10.f,
             "standard deviation of its turn, radians");
  fields.add("most_sigmas", config.most_sigmas, 0.1f, 1e6f,
             "loops that the others contradict by more are dropped, standard deviations");
  fields.add("online", config.online, "close loops while frames come, not at the end alone");
  fields.add("agreeing", config.agreeing, 1, 1000,
             "loops that agree before the map is corrected while frames come");
  fields.add("least_voxels", config.least_voxels, 0.f, 1e6f,
             "what moves less is left to the end, voxels");
  fields.add("pause_m", config.pause_m, 0.f, 1e6f,
             "the camera goes so far before the map is corrected again, metres");
}

std::size_t LoopGraph::take(const std::vector<Keyframe>& keyframes) {
  std::size_t found = 0;
  for (std::size_t at = paths_m_.size(); at < keyframes.size(); ++at) {
    if (at == 0) {
      paths_m_.push_back(0);
      continue;
    }
    const Pose step =
        keyframes[at - 1].world_from_camera.inverse() * keyframes[at].world_from_camera;
    edges_.push_back({at - 1, at, step, config_.step_sigma_m, config_.step_sigma_rad, false});
    paths_m_.push_back(paths_m_.back() + step.translation().norm());
    found += add_loops(at, keyframes);
  }
  return found;
}

std::size_t LoopGraph::add_loops(std::size_t at, const std::vector<Keyframe>& keyframes) {
  std::size_t found = 0;
  const auto add = [&](std::optional<PoseEdge> edge, std::size_t place) {
    ++candidates_;
    if (!edge) return;
    edge->from = place, edge->to = at;
    edge->sigma_m = config_.loop_sigma_m, edge->sigma_rad = config_.loop_sigma_rad;
    edges_.push_back(*edge);
    ++found;
  };
  for (const Candidate& candidate : candidates_of(at, keyframes, paths_m_, config_))
    add(verified(keyframes[candidate.place], keyframes[at], track_), candidate.place);
  if (found > 0) return found;
  // No single keyframe shows the place from here; several together may.
  if (const auto place = nearest_place(at, keyframes, paths_m_, config_))
    add(verified(way_through(*place, at, keyframes, paths_m_, config_), keyframes[*place],
                 keyframes[at], track_),
        *place);
  return found;
}

LoopClosure LoopGraph::solve(const std::vector<Keyframe>& keyframes) const {
  LoopClosure closure;
  closure.candidates = candidates_;
  for (const Keyframe& keyframe : keyframes) closure.poses.push_back(keyframe.world_from_camera);
  std::vector<PoseEdge> edges = edges_;
  const auto is_loop = [](const PoseEdge& edge) { return edge.loop; };
  closure.closed = static_cast<std::size_t>(std::count_if(edges.begin(), edges.end(), is_loop));
  if (closure.closed == 0) return closure;
  std::vector<Pose> poses = optimise_poses(closure.poses, edges);
  closure.dropped = std::erase_if(edges, [&](const PoseEdge& edge) {
    return edge.loop && edge_error(poses, edge) > config_.most_sigmas;
  });
  closure.closed -= closure.dropped;
  if (closure.dropped > 0) poses = optimise_poses(closure.poses, edges);
  for (std::size_t i = 0; i < poses.size(); ++i)
    closure.furthest_m = std::max(closure.furthest_m,
                                  (poses[i].translation() - closure.poses[i].translation()).norm());
  if (closure.closed > 0) closure.poses = std::move(poses);
  return closure;
}

LoopClosure close_loops(const std::vector<Keyframe>& keyframes, const TrackConfig& track,
                        const LoopConfig& config) {
  LoopGraph graph(track, config);
  graph.take(keyframes);
  return graph.solve(keyframes);
}

}  // namespace ovimap
