// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/revise/scattered.h"

#include <gtest/gtest.h>

#include "ovimap/instance/instance_mesh.h"

namespace ovimap {
namespace {

using Eigen::Vector3f;

constexpr InstanceId kInQuestion = 7;
constexpr float kLeastFilled = 0.125f;

/// Every 2 cm of a plate between two directions, of which `share` is there, evenly spread.
std::vector<Vector3f> plate(const Vector3f& along, const Vector3f& across, float share = 1.f) {
  std::vector<Vector3f> points;
  float wanted = 0;
  for (float u = 0; u < along.norm(); u += kSurfaceSpacing_m)
    for (float v = 0; v < across.norm(); v += kSurfaceSpacing_m) {
      wanted += share;
      if (wanted < 1) continue;
      wanted -= 1;
      points.push_back(u * along.normalized() + v * across.normalized());
    }
  return points;
}

bool is_scattered(std::vector<Vector3f> surface) {
  MapDocument map;
  const float voxels = kSurfaceSpacing_m / map.map.config().voxel_size_m;
  InstanceSummary& thing = map.instances.emplace_back();
  thing.id = kInQuestion;
  thing.points = static_cast<std::size_t>(static_cast<float>(surface.size()) * voxels * voxels);
  map.surfaces[kInQuestion] = std::move(surface);
  return ovimap::is_scattered(map, kInQuestion, kLeastFilled);
}

TEST(IsScattered, WhatIsThinOrAslantIsAThing) {
  EXPECT_FALSE(is_scattered(plate({0.3f, 0, 0}, {0, 0.2f, 0}))) << "a book's cover";
  EXPECT_FALSE(is_scattered(plate({0.3f, 0, 0}, {0, 0.2f, 0}, 0.3f))) << "a fence";
  EXPECT_FALSE(is_scattered(plate({0.8f, 0.1f, 0.9f}, {0.04f, 0, -0.04f}))) << "a leaning pole";
}

TEST(IsScattered, WhatIsLeftOfAThingIsNone) {
  EXPECT_TRUE(is_scattered(plate({0.5f, 0, 0}, {0, 0.4f, 0}, 0.07f)));
  EXPECT_TRUE(is_scattered(plate({0.5f, 0, 0.3f}, {0, 0.4f, 0.1f}, 0.07f))) << "aslant";
  MapDocument map;
  EXPECT_TRUE(ovimap::is_scattered(map, kInQuestion, kLeastFilled)) << "there is none";
}

}  // namespace
}  // namespace ovimap
