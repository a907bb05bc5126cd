// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/instance/instance_mesh.h"

#include <set>

#include <gtest/gtest.h>

#include "ovimap/map/rays/sphere_fixture.h"

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

TEST(SampleSurfaces, KeepsOneVertexPerCube) {
  Mesh mesh;
  mesh.vertices = {{0.11f, 0.f, 0.f}, {0.f, 0.f, 0.f}, {0.05f, 0.f, 0.f},
                   {0.05f, 0.f, 0.f}, {0.f, 0.f, 0.f}, {-0.05f, 0.f, 0.f}};
  mesh.labels = {1, 1, 1, 2, 0, 1};
  const InstanceSurfaces surfaces = sample_surfaces(mesh, 0.1f);
  ASSERT_EQ(surfaces.size(), 2u);
  EXPECT_EQ(surfaces.at(1),
            (std::vector<Eigen::Vector3f>{mesh.vertices[0], mesh.vertices[1], mesh.vertices[5]}));
  EXPECT_EQ(surfaces.at(2), std::vector<Eigen::Vector3f>{mesh.vertices[3]});
}

}  // namespace
}  // namespace ovimap
