// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/pictures/place_picture.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "ovimap/base/error.h"

namespace ovimap {
namespace {

using Eigen::Vector3f;

void add_quad(Mesh& mesh, std::uint32_t label, const Vector3f& corner, float width, float depth) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const Vector3f u(width, 0, 0), v(0, depth, 0);
  for (const Vector3f& vertex :
       {corner, Vector3f(corner + u), Vector3f(corner + u + v), Vector3f(corner + v)}) {
    mesh.vertices.push_back(vertex);
    mesh.labels.push_back(label);
    mesh.colors.push_back({40, 90, 160});
  }
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

/// A floor of 4 x 2 m (1), a box of 1 x 1 m on it (2) and a table over that (3).
Mesh stacked_room() {
  Mesh mesh;
  add_quad(mesh, 1, {0, 0, 0}, 4, 2);
  add_quad(mesh, 2, {0.5f, 0.5f, 0.3f}, 1, 1);
  add_quad(mesh, 3, {0.4f, 0.4f, 0.8f}, 1.5f, 1.5f);
  return mesh;
}

double red_share(const RgbImage& image) {
  const auto red = std::count_if(image.begin(), image.end(),
                                 [](Rgb8 c) { return c.r > 2 * c.g && c.r > 2 * c.b; });
  return static_cast<double>(red) / static_cast<double>(image.width() * image.height());
}

TEST(PlacePicture, ShowsAnObjectThatStandsUnderAnother) {
  const RgbImage image = place_picture(stacked_room(), 2, Vector3f::UnitZ());
  EXPECT_EQ(std::max(image.width(), image.height()), 720);
  EXPECT_NEAR(red_share(image), 1.0 / (4.3 * 2.3), 0.02);
}

TEST(PlacePicture, ShowsWhatIsLowerBesideTheObject) {
  const RgbImage image = place_picture(stacked_room(), 3, Vector3f::UnitZ());
  EXPECT_NEAR(red_share(image), 1.5 * 1.5 / (4.3 * 2.3), 0.03);
}

TEST(PlacePicture, DoesWithoutColours) {
  Mesh mesh = stacked_room();
  mesh.colors.clear();
  EXPECT_GT(red_share(place_picture(mesh, 2, Vector3f::UnitZ())), 0.05);
}

TEST(PlacePicture, RefusesWhatIsNotThere) {
  EXPECT_THROW(place_picture(stacked_room(), 7, Vector3f::UnitZ()), Error);
  EXPECT_THROW(place_picture({}, 1, Vector3f::UnitZ()), Error);
}

}  // namespace
}  // namespace ovimap
