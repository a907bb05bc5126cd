// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/track/sensor_doubts.h"

#include <cmath>

#include "ovimap/base/error.h"

namespace ovimap {

namespace {

constexpr int kMostDelay = 15;       // frames that are looked for to either side
constexpr std::size_t kFewest = 60;  // turns that are compared
constexpr double kMuchBetter = 0.5;  // of the error without a shift

/// The turn from each frame to the next, in the camera's frame.
struct Turns {
  std::vector<std::optional<Eigen::Vector3d>> given, tracked;
};

Eigen::Vector3d turn_of(const Pose& from, const Pose& to) {
  return motion_of(from.inverse() * to).tail<3>();
}

Turns turns_of(const std::vector<TrackedFrame>& log) {
  Turns turns;
  for (std::size_t i = 1; i < log.size(); ++i) {
    const TrackedFrame &before = log[i - 1], &now = log[i];
    turns.given.emplace_back();
    turns.tracked.emplace_back();
    if (before.given && now.given) turns.given.back() = turn_of(*before.given, *now.given);
    if (before.tracked && now.tracked && !now.relocated)
      turns.tracked.back() = turn_of(before.world_from_camera, now.world_from_camera);
  }
  return turns;
}

/// Mean square of what given turns differ from tracked ones `delay` frames later; nullopt: too few.
std::optional<double> error_at(const Turns& turns, int delay) {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < turns.given.size(); ++i) {
    const auto other = static_cast<std::ptrdiff_t>(i) + delay;
    if (other < 0 || other >= std::ssize(turns.tracked)) continue;
    const auto& given = turns.given[i];
    const auto& tracked = turns.tracked[static_cast<std::size_t>(other)];
    if (!given || !tracked) continue;
    sum += (*given - *tracked).squaredNorm();
    ++count;
  }
  if (count < kFewest) return std::nullopt;
  return sum / static_cast<double>(count);
}

/// Where a parabola through three errors is least, from the middle one.
double vertex(double before, double middle, double after) {
  const double bend = before - 2 * middle + after;
  return bend > 0 ? (before - after) / (2 * bend) : 0;
}

/// "1.5 frames later".
std::string frames_text(double delay) {
  const double tenths = std::round(10 * std::fabs(delay)) / 10;
  return concat(tenths, tenths == 1 ? " frame " : " frames ", delay > 0 ? "later" : "earlier");
}

void doubt_focal_length(const Tracker& tracker, std::vector<std::string>& doubts) {
  const TrackConfig& config = tracker.config();
  const auto focal = tracker.sensor().log_focal_ratio();
  if (!focal || !focal->beyond(static_cast<double>(config.focal_off),
                               static_cast<double>(config.sensor_sigmas)))
    return;
  doubts.push_back(concat("the images say that the focal length is some ",
                          std::lround(100 * std::fabs(std::expm1(focal->value))), " % ",
                          focal->value > 0 ? "larger" : "smaller",
                          " than given; check fx and fy of camera.yaml or of the recording"));
}

/// Where colour is so late that frames are lost, those that are not tell of less: what is told is
/// the least.
void doubt_color_times(const Tracker& tracker, std::vector<std::string>& doubts) {
  const TrackConfig& config = tracker.config();
  const auto delay = tracker.sensor().color_delay();
  if (!delay || !delay->beyond(static_cast<double>(config.delay_frames),
                               static_cast<double>(config.sensor_sigmas)))
    return;
  doubts.push_back(concat("the images say that colour was taken at least ",
                          frames_text(delay->value),
                          " than the depth beside it; check the time stamps by which the "
                          "recording pairs them"));
}

void doubt_pose_times(const Tracker& tracker, std::vector<std::string>& doubts) {
  const auto delay = pose_delay(tracker.log());
  if (!delay || std::fabs(*delay) < static_cast<double>(tracker.config().delay_frames)) return;
  doubts.push_back(concat("the given poses are those of some ", frames_text(*delay),
                          " than the frames they came with; check the time stamps of the poses"));
}

void doubt_gyroscope(const Tracker& tracker, std::vector<std::string>& doubts) {
  const GyroscopePrior& gyroscope = tracker.gyroscope();
  if (!gyroscope.is_contradicted()) return;
  doubts.push_back(concat("the gyroscope says otherwise than the images how the camera turned (in ",
                          gyroscope.contradicted(), " of ", gyroscope.compared(),
                          " turns), so it was left out; check its axes, its units (radians a "
                          "second) and its clock"));
}

}  // namespace

std::optional<double> pose_delay(const std::vector<TrackedFrame>& log) {
  const Turns turns = turns_of(log);
  const auto undelayed = error_at(turns, 0);
  if (!undelayed) return std::nullopt;
  int best = 0;
  double least = *undelayed;
  for (int delay = -kMostDelay; delay <= kMostDelay; ++delay)
    if (const auto error = error_at(turns, delay); error && *error < least)
      least = *error, best = delay;
  if (least > kMuchBetter * *undelayed) return std::nullopt;
  const auto before = error_at(turns, best - 1), after = error_at(turns, best + 1);
  return best + (before && after ? vertex(*before, least, *after) : 0);
}

std::vector<std::string> sensor_doubts(const Tracker& tracker) {
  std::vector<std::string> doubts;
  doubt_focal_length(tracker, doubts);
  doubt_color_times(tracker, doubts);
  doubt_pose_times(tracker, doubts);
  doubt_gyroscope(tracker, doubts);
  return doubts;
}

}  // namespace ovimap
