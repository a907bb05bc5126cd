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

}  // namespace
}  // namespace ovimap
