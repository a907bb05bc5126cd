// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// Where to stand, by a map, against what can be seen and reached in the rendered place itself.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <ctime>

#include "ovimap/pipeline/approach/approach.h"
#include "ovimap/synth/buildings/benchmark_scenes.h"
#include "ovimap/synth/buildings/floor_plan.h"
#include "ovimap/synth/buildings/room_builder.h"
#include "true_map_fixture.h"

namespace ovimap {
namespace {

constexpr float kVoxel_m = 0.02f;

/// Something that people look for: no wall, floor, ceiling or door.
bool is_thing(const RoomObject& object) {
  return object.footprint.has_value();
}

struct Figures {
  int things = 0, poses = 0, unreached = 0, bumps = 0;
  double right = 0, rays = 0;  ///< of lines of sight, by the map, that are free in the place
  double milliseconds = 0, slowest = 0, processor = 0;
};

class StandingPlaces {
 public:
  StandingPlaces(SynthRoom room, double frames_per_second)
      : room_(std::move(room)), renderer_(room_) {
    const PinholeCamera camera{320, 240, 200.f, 200.f, 159.5f, 119.5f};
    const auto poses = fixture::walk_through(room_, renderer_.scene(), camera, frames_per_second);
    space_ = make_standing_space(fixture::true_map(room_, renderer_, camera, poses, kVoxel_m));
    start_ = poses.front().translation().head<2>().cast<float>();
  }

  Figures judge() const {
    Figures figures;
    for (const RoomObject& object : room_.objects) {
      if (!is_thing(object) || !space_.surfaces.contains(object.id)) continue;
      ++figures.things;
      const std::clock_t worked = std::clock();
      const auto begin = std::chrono::steady_clock::now();
      const Approach approach = find_approach(space_, object.id, robot_, start_);
      const std::chrono::duration<double, std::milli> took =
          std::chrono::steady_clock::now() - begin;
      figures.processor += 1e3 * static_cast<double>(std::clock() - worked) / CLOCKS_PER_SEC;
      figures.milliseconds += took.count();
      figures.slowest = std::max(figures.slowest, took.count());
      figures.unreached += approach.poses.empty();
      for (const ApproachPose& pose : approach.poses) judge(object.id, pose, figures);
    }
    return figures;
  }

 private:
  void judge(InstanceId id, const ApproachPose& pose, Figures& figures) const {
    ++figures.poses;
    for (std::size_t i = 1; i < pose.way.size(); ++i)
      if (bumps(pose.way[i - 1], pose.way[i])) {
        ++figures.bumps;
        break;
      }
    const double seen = truly_seen(id, pose);
    figures.right += std::min(seen / std::max(double{pose.seen}, 1e-6), 1.);
    figures.rays += 1;
  }

  /// The share of the object's visible samples that a ray in the place itself reaches, as
  /// ApproachPose::seen counts them: of those seen from some free place near it. What the map takes
  /// for visible is the denominator, so only sight is judged.
  double truly_seen(InstanceId id, const ApproachPose& pose) const {
    const auto& samples = space_.surfaces.at(id);
    const Eigen::Vector3f eye(pose.place_m.x(), pose.place_m.y(),
                              space_.grid.floor_m + robot_.camera_height_m);
    const Eigen::Vector3f axis(std::cos(pose.yaw_rad) * std::cos(pose.tilt_rad),
                               std::sin(pose.yaw_rad) * std::cos(pose.tilt_rad),
                               std::sin(pose.tilt_rad));
    const float least = std::cos(0.5f * robot_.fov_deg * static_cast<float>(M_PI) / 180.f);
    std::size_t by_map = 0, by_truth = 0;
    for (const SurfaceSample& sample : samples) {
      const Eigen::Vector3f ray = sample.point - eye;
      if (ray.normalized().dot(axis) < least) continue;
      if (-ray.normalized().dot(sample.normal) < 0.17f) continue;
      if (!space_.sight.clear(eye, sample.point)) continue;
      ++by_map;
      const auto hit = renderer_.scene().trace(eye.cast<double>(), ray.cast<double>());
      const bool reaches = hit && (room_.objects[hit->object].id == id ||
                                   hit->distance * double{ray.norm()} > ray.norm() - 2 * kVoxel_m);
      by_truth += reaches;
    }
    return by_map == 0
               ? 0.
               : double{pose.seen} * static_cast<double>(by_truth) / static_cast<double>(by_map);
  }

  /// Whether the robot, less a cell, runs into anything on a straight piece of its way.
  bool bumps(const Eigen::Vector2f& from, const Eigen::Vector2f& to) const {
    const float radius = robot_.radius_m - space_.grid.cell_m;
    const float length = (to - from).norm();
    for (float along = 0; along <= length; along += 0.05f) {
      const Eigen::Vector2f at = from + (to - from) * (along / std::max(length, 1e-6f));
      for (const float height : {0.15f, 0.4f, 0.7f, 1.1f})
        for (int k = 0; k < 16; ++k) {
          const float angle = static_cast<float>(k) * static_cast<float>(M_PI) / 8.f;
          const Eigen::Vector3f direction(std::cos(angle), std::sin(angle), 0.f);
          if (renderer_.scene().occluded({at.x(), at.y(), height}, direction, radius)) return true;
        }
    }
    return false;
  }

  SynthRoom room_;
  Renderer renderer_;
  StandingSpace space_;
  Eigen::Vector2f start_;
  ApproachConfig robot_;
};

void expect_good_places(const char* name, SynthRoom room) {
  const Figures figures = StandingPlaces(std::move(room), 1.).judge();
  std::printf(
      "%s: %d things, %d cannot be reached, %d poses, %.1f %% of their sight is free, "
      "%d ways touch something, %.1f ms each (%.1f of processors), %.1f ms the slowest\n",
      name, figures.things, figures.unreached, figures.poses, 100 * figures.right / figures.rays,
      figures.bumps, figures.milliseconds / figures.things, figures.processor / figures.things,
      figures.slowest);
  ASSERT_GT(figures.things, 5);
  EXPECT_GT(figures.poses, figures.things);
  EXPECT_LT(figures.unreached, figures.things / 3);
  EXPECT_GT(figures.right / figures.rays, 0.95);
  EXPECT_LE(figures.bumps, figures.poses / 20);
}

bool furnished() {
  return std::filesystem::is_directory(default_furniture_folder());
}

TEST(ApproachTruth, InAFlat) {
  if (!furnished()) GTEST_SKIP() << "the Debian package sweethome3d-furniture is not installed";
  expect_good_places("flat", build_plan(floor_plan("flat")));
}

TEST(ApproachTruth, InAnUnseenFlat) {
  if (!furnished()) GTEST_SKIP() << "the Debian package sweethome3d-furniture is not installed";
  expect_good_places("meadow", build_benchmark_scene(benchmark_scenes("meadow").at(0), 1));
}

}  // namespace
}  // namespace ovimap
