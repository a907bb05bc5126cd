// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/render/truth_mesh.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "ovimap/synth/camera/trajectory.h"
#include "ovimap/synth/shapes/mesh_parts.h"

namespace ovimap {
namespace {

const PinholeCamera kScanCamera{80, 60, 60, 60, 39.5f, 29.5f};

/// A floor of 2 x 2 m with a plate of 1 x 1 m half a metre above its middle.
SynthRoom floor_and_plate() {
  SynthRoom room;
  room.objects.resize(2);
  TexturedMesh& floor = room.objects[0].mesh;
  add_panel(floor, {-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, add_material(floor, {}));
  TexturedMesh& plate = room.objects[1].mesh;
  add_panel(plate, {-0.5f, -0.5f, 0.5f}, {1, 0, 0}, {0, 1, 0}, add_material(plate, {}));
  room.objects[0].id = 1, room.objects[1].id = 2;
  return room;
}

double area(const Mesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    sum += 0.5 *
           (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).norm();
  return sum;
}

TEST(TruthMesh, TrianglesAreSmallAndCoverTheSurface) {
  const SynthRoom room = floor_and_plate();
  const Mesh mesh = surface_mesh(room);
  for (const auto& [a, b, c] : mesh.triangles)
    for (const auto& [from, to] : {std::pair{a, b}, {b, c}, {c, a}}) {
      // Merging moves each end by less than a cell.
      EXPECT_LE((mesh.vertices[from] - mesh.vertices[to]).norm(),
                0.025f + 2 * std::sqrt(2.f) * 0.01f);
      EXPECT_EQ(mesh.labels[from], mesh.labels[to]);
    }
  EXPECT_NEAR(area(mesh), 5, 0.1);
  const auto floor = std::count(mesh.labels.begin(), mesh.labels.end(), 1u);
  const auto plate = std::count(mesh.labels.begin(), mesh.labels.end(), 2u);
  EXPECT_NEAR(static_cast<double>(floor) / static_cast<double>(plate), 4, 0.5);  // even density
}

TEST(TruthMesh, OnlyWhatACameraSeesIsKept) {
  const SynthRoom room = floor_and_plate();
  const RayScene scene(room.objects);
  // From straight above at 1.5 m, the plate hides the middle 1.5 m of the floor.
  const std::vector<Pose> above = {looking({0, 0, 1.5}, 0, -1.5707963, 0)};
  const Mesh mesh = surface_mesh(room), seen = seen_part(mesh, scene, kScanCamera, above);
  ASSERT_GT(seen.vertices.size(), 100u);
  bool floor_seen = false;
  for (std::size_t i = 0; i < seen.vertices.size(); ++i) {
    const Eigen::Vector3f& p = seen.vertices[i];
    EXPECT_LE(std::abs(p.y()), 1.5f * 40 / 60 + 1e-4f);  // nothing outside the picture
    if (seen.labels[i] != 1) continue;
    floor_seen = true;
    EXPECT_GT(std::max(std::abs(p.x()), std::abs(p.y())), 0.74f);
  }
  EXPECT_TRUE(floor_seen);
  // A second camera from the side adds floor below the plate.
  const std::vector<Pose> both = {above[0], looking({-1.5, 0, 0.3}, 0, -0.15, 0)};
  EXPECT_GT(seen_part(mesh, scene, kScanCamera, both).vertices.size(), seen.vertices.size() + 100);
  for (const auto& triangle : seen.triangles)
    for (const std::uint32_t index : triangle) ASSERT_LT(index, seen.vertices.size());
}

}  // namespace
}  // namespace ovimap
