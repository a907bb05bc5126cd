// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/report/change_mesh.h"

#include <gtest/gtest.h>

namespace ovimap {
namespace {

using DrawnColor = std::array<std::uint8_t, 3>;
constexpr DrawnColor kCameColor{40, 170, 70}, kWasColor{140, 190, 250}, kWentColor{215, 45, 45};

Eigen::AlignedBox3f meter_at(float x) {
  return {Eigen::Vector3f(x, 0, 0), Eigen::Vector3f(x + 1, 1, 1)};
}

std::shared_ptr<const PastObject> was_at(float x) {
  auto was = std::make_shared<PastObject>();
  was->surface = {{x, 0, 0}, {x, 1, 0}};
  return was;
}

/// A map without surface of its own: all that is drawn is what it kept of the past.
MapDocument map_of_the_past() {
  MapDocument map;
  map.history.events = {
      {3, ObjectEventKind::kAppeared, 2, 1, {}, meter_at(10), 0},
      {5, ObjectEventKind::kMoved, 2, 1, meter_at(20), meter_at(30), 0, was_at(20)},
      {7, ObjectEventKind::kGone, 2, 1, meter_at(40), {}, 0},
      {3, ObjectEventKind::kMoved, 3, 2, meter_at(10), meter_at(50), 0, was_at(10)}};
  return map;
}

std::map<DrawnColor, Eigen::AlignedBox3f> extents_by_color(const Mesh& mesh) {
  std::map<DrawnColor, Eigen::AlignedBox3f> extents;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    extents[mesh.colors[i]].extend(mesh.vertices[i]);
  return extents;
}

TEST(ChangeMesh, ShowsWhereThingsWereAndWhatIsGone) {
  const Mesh mesh = change_mesh(map_of_the_past(), {{3, ObjectEventKind::kAppeared, 0, 0},
                                                    {5, ObjectEventKind::kMoved, 1, 1},
                                                    {7, ObjectEventKind::kGone, 2, 2}});
  const auto extents = extents_by_color(mesh);
  ASSERT_EQ(extents.size(), 3u);
  const auto about = [](const Eigen::AlignedBox3f& box, float x, float width) {
    return std::abs(box.min().x() - x) < 0.1f && std::abs(box.sizes().x() - width) < 0.1f &&
           std::abs(box.sizes().y() - 1) < 0.1f;
  };
  EXPECT_TRUE(about(extents.at(kCameColor), 10, 0)) << "it moved on in a later visit";
  EXPECT_TRUE(about(extents.at(kWasColor), 20, 0));
  EXPECT_TRUE(about(extents.at(kWentColor), 40, 1)) << "of which its box alone was kept";
}

TEST(ChangeMesh, FacesOutward) {
  const Mesh mesh = change_mesh(map_of_the_past(), {{7, ObjectEventKind::kGone, 2, 2}});
  ASSERT_EQ(mesh.triangles.size(), 12u);
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3f normal =
        (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]);
    EXPECT_NEAR(normal.dot(mesh.normals[a]), 1, 1e-5);
    EXPECT_GT(mesh.normals[a].dot(mesh.vertices[a] - meter_at(40).center()), 0);
  }
}

}  // namespace
}  // namespace ovimap
