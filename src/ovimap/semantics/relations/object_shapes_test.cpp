// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/relations/object_shapes.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include <gtest/gtest.h>

namespace ovimap {
namespace {

InstanceSummary boxed(InstanceId id, const Eigen::Vector3f& low, const Eigen::Vector3f& high) {
  InstanceSummary instance;
  instance.id = id;
  instance.box = {low, high};
  instance.centroid = 0.5f * (low + high);
  return instance;
}

TEST(ShapesOfInstances, GoBySurfacesAndElseByBoxes) {
  const std::vector<InstanceSummary> instances{boxed(1, {0, 0, 0}, {4, 4, 4}),
                                               boxed(2, {0, 0, 0}, {1, 1, 0.5f}),
                                               boxed(3, {0, 0, 0}, {1, 1, 0.5f})};
  const InstanceSurfaces surfaces{{1, {{0, 0, 1}, {1, 0, 1}, {0, 1, 2}}}, {3, {}}};
  const auto shapes = shapes_of_instances(Eigen::Vector3f::UnitZ(), instances, surfaces);
  ASSERT_EQ(shapes.size(), 3u);
  EXPECT_EQ(shapes[0].surface.size(), 3u);
  EXPECT_NEAR(shapes[0].height_m(), 1.f, 0.02f);
  for (const std::size_t by_box : {1, 2}) {
    EXPECT_TRUE(shapes[by_box].surface.empty());
    EXPECT_FLOAT_EQ(shapes[by_box].height_m(), 0.5f);
    EXPECT_NEAR(area_m2(shapes[by_box].footprint), 1.f, 1e-5f);
  }
}

TEST(ShapesOfInstances, TakeAnObjectWithoutBoxForItsCentroid) {
  InstanceSummary lost;
  lost.centroid = {1, 2, 3};
  const auto shapes = shapes_of_instances(Eigen::Vector3f::UnitZ(), std::span(&lost, 1), {});
  EXPECT_NEAR(shapes[0].bottom_m, 3.f, 0.01f);
  EXPECT_NEAR(shapes[0].height_m(), 0.f, 0.02f);
  EXPECT_LT(area_m2(shapes[0].footprint), 0.001f);
}

TEST(ShapesOfInstances, HaveFewCornersHoweverTheirPointsLie) {
  constexpr int kPoints = 20000;
  std::vector<Eigen::Vector3f> circle;
  for (int i = 0; i < kPoints; ++i) {
    const float turn = 2.f * std::numbers::pi_v<float> * static_cast<float>(i) / kPoints;
    circle.emplace_back(3.f * std::cos(turn), 3.f * std::sin(turn), 1.f);
  }
  std::vector<InstanceSummary> instances(1);
  instances[0].id = 1;
  const auto shapes = shapes_of_instances(Eigen::Vector3f::UnitZ(), instances, {{1, circle}});
  EXPECT_LE(shapes[0].footprint.size(), 256u);
  EXPECT_NEAR(area_m2(shapes[0].footprint), 9.f * std::numbers::pi_v<float>, 0.2f);
}

TEST(ObjectShapes, ReadSurfacesWhenTheyAreAskedForAndOnce) {
  const ObjectShape box =
      shape_of_box(Eigen::Matrix3f::Identity(), {Eigen::Vector3f::Zero(), Eigen::Vector3f::Ones()},
                   Eigen::Vector3f::Constant(0.5f));
  int reads = 0;
  const ObjectShapes shapes({box}, {ObjectMeasures{}}, [&] {
    if (++reads == 1) throw std::runtime_error("the file is away");
    std::vector<ObjectShape> whole{box};
    whole[0].surface = {Eigen::Vector3f::Zero()};
    return whole;
  });
  EXPECT_EQ(shapes.outline(0).height_m(), 1.f);
  EXPECT_EQ(reads, 0);
  EXPECT_THROW(shapes.whole(), std::runtime_error);
  const ObjectShapes same = shapes;
  EXPECT_EQ(shapes.whole()[0].surface.size(), 1u);
  EXPECT_EQ(same.whole()[0].surface.size(), 1u);
  EXPECT_EQ(reads, 2);
}

TEST(ObjectShapes, MeasureWhatIsWhole) {
  const ObjectShape box =
      shape_of_box(Eigen::Matrix3f::Identity(),
                   {Eigen::Vector3f::Zero(), Eigen::Vector3f(2, 1, 0.5f)}, Eigen::Vector3f::Zero());
  const ObjectShapes shapes({box});
  EXPECT_NEAR(shapes.measures()[0].length_m, 2.f, 1e-5f);
  EXPECT_EQ(&shapes.whole()[0], &shapes.outline(0));
}

}  // namespace
}  // namespace ovimap
