// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ablation_schedule.h"

#include <algorithm>
#include <cmath>

#include "ovimap/base/error.h"

namespace ovimap::apps {

namespace {

constexpr std::size_t kPairs = 40;        // of successive frames that are looked at
constexpr double kFastest_mps = 2;        // a brisk walk is 1.8
constexpr double kFastestTurn_rad_s = 3;  // median over a recording; half a turn a second
constexpr double kLeastRate = 3;          // frames a second

struct Motion {
  double seconds = 0, metres_per_s = 0, radians_per_s = 0;
};

double median(std::vector<Motion> motions, double Motion::*field) {
  const auto middle = motions.begin() + std::ssize(motions) / 2;
  std::nth_element(motions.begin(), middle, motions.end(),
                   [&](const Motion& a, const Motion& b) { return a.*field < b.*field; });
  return *middle.*field;
}

/// Between pairs of successive frames, evenly over the recording; unreadable ones are left out.
std::vector<Motion> motions_of(const FrameSource& source,
                               const std::vector<std::int64_t>& positions) {
  std::vector<Motion> motions;
  const std::size_t pairs = std::min(kPairs, positions.size() - 1);
  for (std::size_t k = 0; k < pairs; ++k) {
    const std::size_t i = k * (positions.size() - 1) / pairs;
    const auto a = source.read(positions[i]).frame, b = source.read(positions[i + 1]).frame;
    if (!a || !b) continue;
    const double seconds = b->timestamp_s - a->timestamp_s;
    if (!(seconds > 0)) continue;
    const Pose step = a->world_from_camera.inverse() * b->world_from_camera;
    motions.push_back({seconds, step.translation().norm() / seconds,
                       Eigen::AngleAxisd(Eigen::Matrix3d(step.linear())).angle() / seconds});
  }
  return motions;
}

}  // namespace

double video_rate(const FrameSource& source, const std::vector<std::int64_t>& positions,
                  const std::string& path) {
  const char* remedy =
      "; the schedule is one of a video (ovimap synth DIR --walk renders one), and means nothing "
      "on "
      "single frames from all sides";
  std::vector<Motion> motions;
  if (positions.size() > 1) motions = motions_of(source, positions);
  if (motions.empty()) throw Error(concat(path, ": no two successive frames with times", remedy));
  const double rate = 1 / median(motions, &Motion::seconds);
  if (rate < kLeastRate)
    throw Error(
        concat(path, ": ", rate, " frames a second, at least ", kLeastRate, " are needed", remedy));
  const double speed = median(motions, &Motion::metres_per_s);
  const double turn = median(motions, &Motion::radians_per_s);
  if (speed > kFastest_mps || turn > kFastestTurn_rad_s)
    throw Error(concat(path, ": by its frames' times the camera moves ", speed, " m and turns ",
                       turn, " rad a second, which nobody who carries it does", remedy));
  return rate;
}

int frames_between(double period_s, double frames_per_s) {
  return std::max(1, static_cast<int>(std::lround(period_s * frames_per_s)));
}

}  // namespace ovimap::apps
