// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// What a gyroscope is worth to tracking: a rendered walk with pans aside and back, followed with
// and without, by all frames and by some, in the light and in the dark.
#include <cstdio>
#include <cstdlib>
#include <numbers>

#include "ovimap/base/error.h"
#include "ovimap/eval/trajectories/trajectory_scores.h"
#include "ovimap/map/fusion/integrate.h"
#include "ovimap/synth/buildings/room_builder.h"
#include "ovimap/synth/recordings/sequence.h"
#include "ovimap/synth/rooms/rooms_v1.h"
#include "ovimap/track/tracker.h"

using namespace ovimap;

namespace {

constexpr float kGyroscope_hz = 200, kVoxel_m = 0.02f;
constexpr double kDegree = std::numbers::pi / 180;

struct Film {
  std::vector<Frame> frames;
  std::vector<TimedPose> truth;
};

Film film_of(const std::string& room, double whip_deg_s, float seconds) {
  VideoConfig video;
  video.walk.whip_rad_s = static_cast<float>(whip_deg_s * kDegree);
  video.walk.seconds = seconds;
  video.gyroscope.rate_hz = kGyroscope_hz;
  SynthSequenceConfig config;
  config.noise = true;
  const SynthSequence sequence(build_room(room_spec(room)), synth_camera(320, 240), video, config);
  const OrientationTimeline orientations(sequence.turn_rates());
  Film film;
  for (std::int64_t i = 0; i < sequence.size(); ++i) {
    Frame frame = *sequence.read(i).frame;
    frame.posed = false;
    frame.orientation = orientations.at(frame.timestamp_s);
    film.truth.push_back({frame.timestamp_s, sequence.true_poses()[static_cast<std::size_t>(i)]});
    film.frames.push_back(std::move(frame));
  }
  return film;
}

struct Case {
  const char* name;
  std::size_t step = 1;
  bool dark = false;  ///< depth cameras see in the dark, their colour cameras nothing
};

void follow(const Film& film, const Case& shot, bool gyroscope) {
  TrackConfig config;
  config.gyroscope = gyroscope;
  Tracker tracker(config);
  VoxelMapConfig map_config;
  map_config.voxel_size_m = kVoxel_m;
  VoxelMap map(map_config);
  std::vector<TimedPose> estimate;
  for (std::size_t i = 0; i < film.frames.size(); i += shot.step) {
    Frame frame = film.frames[i];
    if (shot.dark) frame.color.fill({8, 8, 8});
    const TrackedFrame& tracked = tracker.track(frame, map);
    if (!tracked.tracked) continue;
    integrate(map, {.depth = frame.depth,
                    .camera = frame.depth_camera,
                    .world_from_camera = tracked.world_from_camera});
    estimate.push_back({frame.timestamp_s, tracked.world_from_camera});
  }
  const TrackSummary summary = summarise(tracker.log());
  std::string error_cm = "- | -";
  if (estimate.size() >= 3) {
    const TrajectoryScores scores = score_trajectory(film.truth, estimate, 0.001);
    char text[64];
    std::snprintf(text, sizeof(text), "%.2f | %.2f", 100 * scores.ate_m.rmse,
                  100 * scores.ate_m.max);
    error_cm = text;
  }
  std::printf("| %s | %s | %zu of %zu | %zu | %s |\n", shot.name, gyroscope ? "yes" : "no",
              summary.tracked, summary.frames, summary.lost_times, error_cm.c_str());
  std::fflush(stdout);
}

}  // namespace

int main(int count, char** arguments) try {
  if (count != 4) {
    std::fprintf(stderr, "usage: %s ROOM DEGREES_A_SECOND SECONDS\n", arguments[0]);
    return 2;
  }
  const Film film =
      film_of(arguments[1], std::atof(arguments[2]), static_cast<float>(std::atof(arguments[3])));
  std::puts("| frames | gyroscope | tracked | lost | ATE rmse, cm | max, cm |");
  std::puts("| --- | --- | --- | --- | --- | --- |");
  for (const Case& shot : {Case{"all"}, Case{"every third", 3}, Case{"every sixth", 6},
                           Case{"every tenth", 10}, Case{"every third, in the dark", 3, true}})
    for (const bool gyroscope : {false, true}) follow(film, shot, gyroscope);
  return 0;
} catch (const Error& fault) {
  std::fprintf(stderr, "%s\n", fault.what());
  return 2;
}
