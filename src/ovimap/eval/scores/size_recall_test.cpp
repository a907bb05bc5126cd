// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/eval/scores/size_recall.h"

#include <gtest/gtest.h>

namespace ovimap {
namespace {

/// The corners and the middle of an upright box, turned by an angle about the vertical.
void add_box(SizedScene& scene, std::vector<Eigen::Vector3f>& points, std::int32_t id,
             const Eigen::Vector3f& size, std::uint32_t predicted, float angle = 0) {
  const float c = std::cos(angle), s = std::sin(angle);
  for (int i = 0; i < 8; ++i) {
    const float x = (i & 1 ? 0.5f : -0.5f) * size.x(), y = (i & 2 ? 0.5f : -0.5f) * size.y();
    points.emplace_back(c * x - s * y + static_cast<float>(id), s * x + c * y,
                        i & 4 ? size.z() : 0.f);
    scene.truth.push_back(id);
    scene.predicted.push_back(predicted);
  }
}

TEST(SizeRecallTest, BoxesTurnWithTheThing) {
  SizedScene scene;
  std::vector<Eigen::Vector3f> points;
  add_box(scene, points, 3, {0.4f, 0.1f, 0.02f}, 1, 0.5235988f);  // 30 degrees: a step of the turns
  const MeasuredSize size = measured_sizes(points, scene.truth).at(3);
  EXPECT_NEAR(size.litres, 0.8f, 0.01f);
  EXPECT_NEAR(size.thickness_m, 0.02f, 1e-4f);
  EXPECT_NEAR(size.breadth_m, 0.1f, 1e-3f);
}

TEST(SizeRecallTest, ThingsCountInTheirGroups) {
  SizedScene scene;
  std::vector<Eigen::Vector3f> points;
  add_box(scene, points, 1, {0.3f, 0.2f, 0.002f}, 11);   // a sheet: small and flat, found
  add_box(scene, points, 2, {0.1f, 0.1f, 0.1f}, 0);      // a cup, missed
  add_box(scene, points, 3, {0.2f, 0.2f, 0.25f}, 13);    // 10 litres, found
  add_box(scene, points, 4, {1, 1, 0.5f}, 13);           // shares the object of the last: neither
  add_box(scene, points, 5, {0.02f, 0.02f, 0.02f}, 15);  // not scored, found
  add_box(scene, points, 6, {4, 0.02f, 2.5f}, 0);        // a wall
  scene.sizes = measured_sizes(points, scene.truth);
  scene.unscored = {5};
  scene.structure = {6};
  // Two of the eight points of thing 3 are lost, so that the other has more of their object.
  scene.predicted[16] = scene.predicted[17] = 0;
  const SizeRecall recall = recall_by_size(std::vector{scene});
  EXPECT_EQ(recall.small.things, 2);
  EXPECT_EQ(recall.small.found, 1);
  EXPECT_EQ(recall.medium.things, 1);
  EXPECT_EQ(recall.medium.found, 0);
  EXPECT_EQ(recall.large.things, 1);
  EXPECT_EQ(recall.large.found, 1);
  EXPECT_EQ(recall.flat.things, 1);
  EXPECT_EQ(recall.flat.found, 1);
  EXPECT_EQ(recall.unscored.things, 1);
  EXPECT_EQ(recall.unscored.found, 1);
  EXPECT_DOUBLE_EQ(recall.objects_per_thing, 0.5);
  EXPECT_DOUBLE_EQ(recall.small.recall(), 0.5);
}

}  // namespace
}  // namespace ovimap
