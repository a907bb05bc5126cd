// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/camera/trajectory.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "ovimap/base/config.h"
#include "ovimap/synth/camera/gaze_planner.h"
#include "ovimap/synth/camera/walk_path.h"
#include "ovimap/synth/shapes/random.h"

namespace ovimap {
namespace {

constexpr std::uint64_t kSwayStream = 5001;
constexpr int kKeyframes = 24;  // gaze decisions a lap
constexpr double kSway_rad = 0.02;

/// A sum of slow waves with random phases, within [-1, 1].
class Sway {
 public:
  explicit Sway(Random& random) {
    for (double& phase : phases_) phase = random.uniform(0, 6.2831853f);
  }
  double at(double lap) const {
    return (std::sin(2 * std::numbers::pi * lap + phases_[0]) +
            std::sin(2 * std::numbers::pi * 2 * lap + phases_[1]) +
            std::sin(2 * std::numbers::pi * 3 * lap + phases_[2])) /
           3;
  }

 private:
  std::array<double, 3> phases_{};
};

/// The curve through equally spaced values (Catmull and Rom).
double through(const std::vector<double>& values, double at) {
  const auto value = [&](int i) {
    return values[static_cast<std::size_t>(std::clamp(i, 0, static_cast<int>(values.size()) - 1))];
  };
  const int i = static_cast<int>(std::floor(at));
  const double t = at - i, a = value(i - 1), b = value(i), c = value(i + 1), d = value(i + 2);
  return b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)));
}

}  // namespace

void list_fields(TrajectoryConfig& config, ConfigFields& fields) {
  fields.add("lowest_eye_m", config.lowest_eye_m, 0.1f, 3.f, "lowest camera height, metres");
  fields.add("highest_eye_m", config.highest_eye_m, 0.1f, 3.f, "highest camera height, metres");
  fields.add("body_radius_m", config.body_radius_m, 0.f, 2.f,
             "kept between the camera and walls or tall furniture, metres");
  fields.add("low_furniture_cost", config.low_furniture_cost, 1.f, 1000.f,
             "how much longer a way is preferred to one over low furniture");
  fields.add("laps", config.laps, 1, 1000, "rounds of the room");
  fields.add("max_turn_rad", config.max_turn_rad, 0.01f, 3.f,
             "largest turn between two frames, radians");
  fields.add("max_gaze_turn_rad", config.max_gaze_turn_rad, 0.01f, 3.f,
             "largest turn between two decisions where to look, radians");
}

Pose looking(const Eigen::Vector3d& eye_m, double yaw_rad, double pitch_rad, double roll_rad) {
  const Eigen::Vector3d forward(std::cos(pitch_rad) * std::cos(yaw_rad),
                                std::cos(pitch_rad) * std::sin(yaw_rad), std::sin(pitch_rad));
  const Eigen::Vector3d right(std::sin(yaw_rad), -std::cos(yaw_rad), 0);
  const Eigen::Vector3d down = forward.cross(right);
  Pose pose = Pose::Identity();
  pose.linear().col(0) = std::cos(roll_rad) * right + std::sin(roll_rad) * down;
  pose.linear().col(1) = std::cos(roll_rad) * down - std::sin(roll_rad) * right;
  pose.linear().col(2) = forward;
  pose.translation() = eye_m;
  return pose;
}

std::vector<Pose> plan_trajectory(const SynthRoom& room, const RayScene& scene,
                                  const PinholeCamera& camera, int frames,
                                  const TrajectoryConfig& config) {
  const int laps = config.laps;
  const std::vector<Eigen::Vector2f> walk = walk_round(room, laps, frames, config);
  Random random(room.seed, kSwayStream);
  const Sway rise(random), nod(random), lean(random);
  const double middle = (config.lowest_eye_m + config.highest_eye_m) / 2;
  const double swing = (config.highest_eye_m - config.lowest_eye_m) / 2;
  std::vector<Eigen::Vector3d> eyes;
  for (int i = 0; i < frames; ++i) {
    const auto& plan = walk[static_cast<std::size_t>(i)];
    eyes.emplace_back(plan.x(), plan.y(),
                      middle + swing * rise.at(static_cast<double>(laps) * i / frames));
  }

  const int step = std::max(1, frames / (laps * kKeyframes));
  std::vector<Eigen::Vector3d> stops;
  for (std::size_t i = 0; i < eyes.size(); i += static_cast<std::size_t>(step))
    stops.push_back(eyes[i]);
  const double reach =
      std::min(config.max_turn_rad * static_cast<float>(step), config.max_gaze_turn_rad);
  std::vector<double> yaws, pitches;
  for (const Gaze& gaze : plan_gazes(room, scene, camera, stops, reach)) {
    yaws.push_back(gaze.yaw_rad);
    pitches.push_back(gaze.pitch_rad);
  }

  std::vector<Pose> poses;
  for (int i = 0; i < frames; ++i) {
    const double key = static_cast<double>(i) / step, lap = static_cast<double>(laps) * i / frames;
    poses.push_back(looking(eyes[static_cast<std::size_t>(i)], through(yaws, key),
                            through(pitches, key) + kSway_rad * nod.at(lap),
                            kSway_rad * lean.at(lap)));
  }
  return poses;
}

}  // namespace ovimap
