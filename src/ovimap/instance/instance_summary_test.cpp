// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/instance/instance_summary.h"

#include <gtest/gtest.h>

#include "ovimap/map/rays/sphere_fixture.h"

namespace ovimap {
namespace {

TEST(SummarizeInstances, DescribesASphere) {
  const SphereScene scene;
  VoxelMap map;
  const Label label = map.labels().create();
  scene.integrate_views(map, 12, label);
  InstanceRegistry registry;
  const Segments segments{IdImage(1, 1), {{1, 500}}};
  const std::vector<SegmentAssociation> associations{{label, false, {}, {{label, 500}}}};
  for (int frame = 0; frame < 3; ++frame)
    registry.observe(segments, associations, frame, true, map.labels());

  const auto summaries = summarize_instances(map, registry, {});
  ASSERT_EQ(summaries.size(), 1u);
  EXPECT_EQ(summaries[0].id, registry.instance_of(label));
  EXPECT_EQ(summaries[0].views, 3);
  EXPECT_LT(summaries[0].centroid.norm(), 0.02f);
  EXPECT_NEAR(summaries[0].box.max().x(), SphereScene::kRadius, 0.02f);
  EXPECT_NEAR(summaries[0].box.min().z(), -SphereScene::kRadius, 0.02f);
  EXPECT_EQ(summaries[0].super_points, std::vector<Label>{label});
}

TEST(SummarizeInstances, LeavesOutWhatIsSmallOrSeenOnce) {
  const SphereScene scene;
  VoxelMap map;
  const Label label = map.labels().create();
  scene.integrate_views(map, 2, label);
  InstanceRegistry registry;
  const Segments segments{IdImage(1, 1), {{1, 500}}};
  const std::vector<SegmentAssociation> associations{{label, false, {}, {{label, 500}}}};
  registry.observe(segments, associations, 0, true, map.labels());
  EXPECT_TRUE(summarize_instances(map, registry, {}).empty());
  EXPECT_EQ(summarize_instances(map, registry, {.min_instance_views = 1}).size(), 1u);
  EXPECT_TRUE(
      summarize_instances(map, registry, {.min_instance_voxels = 1000000, .min_instance_views = 1})
          .empty());
}

SurfaceExtent surface_of(int points) {
  SurfaceExtent extent;
  for (int i = 0; i < points; ++i) extent.add({0.01f * static_cast<float>(i), 0, 0});
  return extent;
}

/// Super-points that are an instance each, seen as often as they are sighted.
std::vector<InstanceSummary> listed(const EntitySightings& sightings,
                                    const SurfaceExtents& extents) {
  LabelForest forest;
  InstanceRegistry::State state;
  for (const auto& [root, seen] : sightings) {
    forest.create();
    SuperPoint& point = state.super_points[root];
    point.votes[++state.last_id] = static_cast<int>(seen.size());
    point.seen = FrameRuns({{0, static_cast<std::uint32_t>(seen.size())}});
  }
  state.entity_sightings = sightings;
  InstanceRegistry registry;
  registry.restore(state);
  return summarize_instances(extents, forest, registry, {});
}

TEST(SummarizeInstances, KeepsWhatWasSeenOnceInAGoodMask) {
  const SurfaceExtents extents{{1, surface_of(100)}};
  EXPECT_EQ(listed({{1, {{0, 7, 200}}}}, extents).size(), 1u);
  EXPECT_TRUE(listed({{1, {{0, 7, 100}}}}, extents).empty()) << "a doubtful mask";
  EXPECT_TRUE(listed({{1, {{0, 7}}}}, extents).empty()) << "nobody said how good it is";
  EXPECT_EQ(listed({{1, {{0, 7}, {1, 2}}}}, extents).size(), 1u) << "it was seen twice";
}

TEST(SummarizeInstances, LeavesOutALeftoverOfWhatAGoodMaskShowed) {
  const EntitySightings sightings{{1, {{0, 7, 200}}}, {2, {{0, 7, 200}, {1, 3, 200}}}};
  const auto ids = [&](int first, int second) {
    return listed(sightings, {{1, surface_of(first)}, {2, surface_of(second)}}).size();
  };
  EXPECT_EQ(ids(100, 50), 2u);
  EXPECT_EQ(ids(50, 100), 1u);
}

/// However many frames show it.
TEST(SummarizeInstances, LeavesOutWhatMasksHardlyShowAsAThing) {
  const SurfaceExtents extents{{1, surface_of(1000)}, {2, surface_of(100)}};
  EntitySightings sightings;
  for (std::uint32_t frame = 0; frame < 20; ++frame)
    for (const Label root : {1u, 2u}) sightings[root].push_back({frame, 7, 250});
  const auto objects = listed(sightings, extents);
  ASSERT_EQ(objects.size(), 1u);
  EXPECT_EQ(objects[0].points, 1000u);
}

TEST(SummarizeInstances, TellsHowSureRatedMasksAre) {
  const SurfaceExtents extents{{1, surface_of(100)}, {2, surface_of(100)}};
  const auto rated =
      listed({{1, {{0, 7, 255}, {1, 2, 255}}}, {2, {{0, 9, 102}, {1, 5, 102}}}}, extents);
  ASSERT_EQ(rated.size(), 2u);
  EXPECT_FLOAT_EQ(rated[0].confidence.value(), 0.5f);  // two frames for it, two of doubt
  EXPECT_FLOAT_EQ(rated[1].confidence.value(), 0.2f);
  const auto taken_for_true = listed({{1, {{0, 7}, {1, 2}}}}, extents);
  ASSERT_EQ(taken_for_true.size(), 1u);
  EXPECT_FALSE(taken_for_true[0].confidence.has_value());
}

}  // namespace
}  // namespace ovimap
