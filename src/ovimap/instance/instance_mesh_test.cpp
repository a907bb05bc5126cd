// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/instance/instance_mesh.h"

#include <set>

#include <gtest/gtest.h>

#include "ovimap/map/sphere_fixture.h"

namespace ovimap {
namespace {

TEST(ExtractInstanceMesh, LabelsVerticesByListedInstancesOnly) {
  const SphereScene scene;
  VoxelMap map;
  const Label label = map.labels().create();
  scene.integrate_views(map, 8, label);
  InstanceSummary instance;
  instance.id = 42;
  instance.super_points = {label};
  const auto labels = [&](std::span<const InstanceSummary> instances) {
    const Mesh mesh = extract_instance_mesh(map, instances);
    return std::set<std::uint32_t>(mesh.labels.begin(), mesh.labels.end());
  };
  EXPECT_TRUE(labels(std::span(&instance, 1)).contains(42));
  EXPECT_EQ(labels({}), std::set<std::uint32_t>{0});
}

}  // namespace
}  // namespace ovimap
