// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "query_approach.h"

#include <cmath>
#include <cstdio>

namespace ovimap::apps {

std::optional<Eigen::Vector2f> ApproachOptions::start() const {
  if (from.empty()) return std::nullopt;
  return Eigen::Vector2f(from[0], from[1]);
}

void add_approach_options(CLI::App& command, ApproachOptions& options) {
  command.add_flag("--approach", options.asked,
                   "where a robot stands to see each object, and how it gets there");
  options.details = {
      command
          .add_option(
              "--from", options.from,
              "of --approach: X,Y where the robot is; else: anywhere in the largest free space")
          ->delimiter(',')
          ->expected(2),
      command
          .add_option("--radius", options.config.radius_m, "of --approach: of the robot, metres")
          ->check(CLI::Range(0.01, 10.))
          ->capture_default_str(),
      command
          .add_option("--camera-height", options.config.camera_height_m,
                      "of --approach: of the camera above the floor, metres; the robot is as high")
          ->check(CLI::Range(0.05, 10.))
          ->capture_default_str(),
      command
          .add_option("--fov", options.config.fov_deg,
                      "of --approach: field of view of the camera, degrees")
          ->check(CLI::Range(1., 180.))
          ->capture_default_str(),
      command
          .add_option("--range", options.config.range_m,
                      "of --approach: at most so far from the object, metres")
          ->check(CLI::Range(0.05, 20.))
          ->capture_default_str()};
}

void check_approach_options(const ApproachOptions& options) {
  for (const CLI::Option* detail : options.details)
    if (!options.asked && detail->count() > 0)
      throw Error(concat(detail->get_name(), " is of --approach; add that, or leave it out"));
}

void print_approach(const Approach& approach) {
  if (approach.poses.empty())
    std::printf("         cannot be reached: %s\n", approach.reason.c_str());
  for (const ApproachPose& pose : approach.poses) {
    constexpr double kDegrees = 180. / M_PI;
    std::printf(
        "         stand at %.2f %.2f, facing %.0f degrees, %.0f %s: %.0f %% seen from %.2f m",
        double{pose.place_m.x()}, double{pose.place_m.y()}, kDegrees * double{pose.yaw_rad},
        std::abs(kDegrees * double{pose.tilt_rad}), pose.tilt_rad < 0.f ? "down" : "up",
        100. * double{pose.seen}, double{pose.distance_m});
    if (!pose.way.empty()) std::printf(", %.1f m to go:", double{pose.way_m});
    for (const Eigen::Vector2f& corner : pose.way)
      std::printf(" %.2f,%.2f", double{corner.x()}, double{corner.y()});
    std::printf("\n");
  }
}

}  // namespace ovimap::apps
