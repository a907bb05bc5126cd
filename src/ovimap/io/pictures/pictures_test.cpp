// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/pictures/pictures.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "ovimap/base/config.h"
#include "ovimap/io/mesh/mesh_pieces.h"
#include "ovimap/io/pictures/palette.h"
#include "ovimap/io/pictures/pictures_scale_bar.h"

namespace ovimap {
namespace {

using Eigen::Vector3f;

constexpr Rgb8 kGround = {247, 247, 244};

void add_quad(Mesh& mesh, std::uint32_t label, const Vector3f& corner, const Vector3f& u,
              const Vector3f& v) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Vector3f& vertex :
       {corner, Vector3f(corner + u), Vector3f(corner + u + v), Vector3f(corner + v)}) {
    mesh.vertices.push_back(vertex);
    mesh.labels.push_back(label);
    mesh.colors.push_back({200, 100, 50});
  }
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

/// A floor of 4 x 2 m (label 1), a table of 1 x 1 m on it (2) and a ceiling seen from below (3).
Mesh room() {
  Mesh mesh;
  add_quad(mesh, 1, {0, 0, 0}, {4, 0, 0}, {0, 2, 0});
  add_quad(mesh, 2, {0.5f, 0.5f, 0.8f}, {1, 0, 0}, {0, 1, 0});
  add_quad(mesh, 3, {0, 0, 2.5f}, {0, 2, 0}, {4, 0, 0});
  return mesh;
}

/// Full light, one sample a pixel, nothing added or trimmed: colours are exact.
PictureConfig plain() {
  PictureConfig config;
  config.longest_side_px = 432;  // 4 m and 4 % margins: 100 pixels a metre
  config.supersampling = 1;
  config.ambient = 1;
  config.trim = 0;
  config.scale_bar = false;
  return config;
}

std::size_t count(const RgbImage& image, Rgb8 color) {
  return static_cast<std::size_t>(std::count(image.begin(), image.end(), color));
}

TEST(TopDown, ShowsEachInstanceAtItsSize) {
  const RgbImage image = top_down(room(), Vector3f::UnitZ(), plain());
  EXPECT_EQ(image.width(), 432);
  EXPECT_EQ(image.height(), 232);
  EXPECT_NEAR(static_cast<double>(count(image, instance_color(2))), 100 * 100, 210);
  EXPECT_NEAR(static_cast<double>(count(image, instance_color(1))), 400 * 200 - 100 * 100, 610);
  EXPECT_EQ(count(image, instance_color(3)), 0u);
  EXPECT_EQ(image.at(2, 2), kGround);
}

TEST(TopDown, RemovesTheCeilingByHeightWhenBackFacesStay) {
  PictureConfig config = plain();
  config.cull_back_faces = false;
  EXPECT_EQ(count(top_down(room(), Vector3f::UnitZ(), config), instance_color(3)), 0u);
  config.drop_top = 0;
  EXPECT_GT(count(top_down(room(), Vector3f::UnitZ(), config), instance_color(3)), 70000u);
  EXPECT_GT(count(top_down(room(), Vector3f::UnitZ(), config, 1.0f), instance_color(2)), 9000u);
  EXPECT_EQ(count(top_down(room(), Vector3f::UnitZ(), config, 0.5f), instance_color(2)), 0u);
}

TEST(TopDown, LooksAlongAnyAxisAndLiesAlongTheLongerSide) {
  Mesh mesh = room();
  for (Vector3f& vertex : mesh.vertices)
    vertex = Vector3f(vertex.y(), -vertex.z(), -vertex.x());  // y down
  const RgbImage image = top_down(mesh, -Vector3f::UnitY(), plain());
  EXPECT_EQ(image.width(), 432);
  EXPECT_EQ(image.height(), 232);
  EXPECT_NEAR(static_cast<double>(count(image, instance_color(2))), 100 * 100, 210);
}

TEST(TopDown, ShowsVertexColoursOrGrey) {
  PictureConfig config = plain();
  config.coloring = MeshColoring::kColors;
  EXPECT_GT(count(top_down(room(), Vector3f::UnitZ(), config), {200, 100, 50}), 75000u);
  Mesh bare = room();
  bare.colors.clear();
  EXPECT_GT(count(top_down(bare, Vector3f::UnitZ(), config), instance_color(0)), 75000u);
}

TEST(TopDown, DrawsAMeshThatComesInParts) {
  Mesh mesh = room();
  mesh.normals.assign(mesh.vertices.size(), Vector3f(0.6f, 0, 0.8f));
  add_quad(mesh, 9, {2, 1, 0.5f}, {1, 0, 0.5f},
           {0, 1, 0.2f});  // through the table's height, aslant
  mesh.normals.resize(mesh.vertices.size(), Vector3f::UnitZ());
  constexpr MeshColoring kBoth[] = {MeshColoring::kColors, MeshColoring::kInstances};
  const std::vector<RgbImage> pictures = top_down(
      [&](const auto& visit) {
        for (const auto& [label, part] : split_by_label(mesh)) visit(part);
        visit(Mesh());
      },
      Vector3f::UnitZ(), kBoth);
  ASSERT_EQ(pictures.size(), 2u);
  for (const std::size_t i : {0u, 1u}) {
    PictureConfig config;
    config.coloring = kBoth[i];
    EXPECT_EQ(pictures[i], top_down(mesh, Vector3f::UnitZ(), config)) << i;
  }
}

TEST(TopDown, AMeshWithoutTrianglesIsEmptyGround) {
  const RgbImage image = top_down(Mesh{}, Vector3f::UnitZ(), plain());
  EXPECT_EQ(count(image, kGround), image.size());
  EXPECT_EQ(image.width(), 432);
}

TEST(TopDown, DrawsAScaleBarWhenAsked) {
  PictureConfig config = plain();
  config.scale_bar = true;
  const RgbImage image = top_down(room(), Vector3f::UnitZ(), config);
  EXPECT_GT(count(image, {40, 40, 40}), 50u * 2);  // a fifth of the width holds half a metre
}

TEST(ScaleBar, HasARoundLength) {
  EXPECT_FLOAT_EQ(scale_bar_length_m(432, 100), 0.5f);
  EXPECT_FLOAT_EQ(scale_bar_length_m(1000, 100), 2.f);
  EXPECT_FLOAT_EQ(scale_bar_length_m(1000, 199), 1.f);
  EXPECT_FLOAT_EQ(scale_bar_length_m(1000, 8), 20.f);
}

TEST(ScaleBar, StaysInsideATinyPicture) {
  RgbImage image(3, 3);
  draw_scale_bar(image, 10);
  EXPECT_EQ(image.width(), 3);
}

TEST(TopDown, ShadesByTheAngleToTheLamp) {
  PictureConfig config = plain();
  config.ambient = 0.5f;
  const RgbImage image = top_down(room(), Vector3f::UnitZ(), config);
  const Rgb8 full = instance_color(1), shaded = image.at(216, 116);  // the middle of the floor
  // The lamp is behind the camera at (-0.35, -0.55, -0.75), the floor faces the camera.
  const double light = 0.5 + 0.5 * 0.75 / std::sqrt(0.35 * 0.35 + 0.55 * 0.55 + 0.75 * 0.75);
  EXPECT_NEAR(shaded.r, full.r * light, 1);
  EXPECT_NEAR(shaded.g, full.g * light, 1);
}

TEST(Overlay, BlendsInstancesAndDrawsTheirBoundary) {
  RgbImage color(4, 2, {100, 100, 100});
  IdImage ids(4, 2);
  ids.at(1, 0) = ids.at(1, 1) = ids.at(2, 0) = ids.at(2, 1) = 9;
  const RgbImage image = overlay(color, ids, 0.5f);
  const Rgb8 nine = instance_color(9);
  EXPECT_EQ(image.at(0, 0), (Rgb8{100, 100, 100}));
  EXPECT_NEAR(image.at(1, 0).r, (100 + nine.r) / 2.0, 0.51);
  EXPECT_EQ(image.at(2, 1), nine);
}

TEST(ContactSheet, LaysFramesOutInRows) {
  SheetConfig config;
  config.columns = 2, config.tile_width_px = 10, config.gap_px = 2;
  std::vector<SheetFrame> frames;
  for (std::uint16_t i = 0; i < 3; ++i) {
    const auto grey = static_cast<std::uint8_t>(10 * i);
    frames.push_back(
        {RgbImage(20, 16, {grey, grey, grey}), IdImage(20, 16, static_cast<std::uint16_t>(i + 1))});
  }
  const RgbImage sheet = contact_sheet(frames, config);
  EXPECT_EQ(sheet.width(), 2 * (20 + 2) + 2);
  EXPECT_EQ(sheet.height(), 2 * (8 + 2) + 2);
  EXPECT_EQ(sheet.at(2, 2), (Rgb8{0, 0, 0}));
  EXPECT_EQ(sheet.at(2 + 22, 2), (Rgb8{10, 10, 10}));
  EXPECT_EQ(sheet.at(2, 12), (Rgb8{20, 20, 20}));
  EXPECT_NEAR(sheet.at(12, 12).r, 20 * 0.45 + instance_color(3).r * 0.55, 1);
  EXPECT_EQ(sheet.at(24, 12), kGround);  // the fourth place is free
  EXPECT_GT(contact_sheet({}, config).size(), 0u);
}

TEST(PictureConfigs, ListTheirFields) {
  PictureConfig picture;
  SheetConfig sheet;
  ConfigFields fields;
  fields.group("picture", [&](ConfigFields& f) { list_fields(picture, f); });
  fields.group("sheet", [&](ConfigFields& f) { list_fields(sheet, f); });
  fields.set("picture.coloring", "colors");
  fields.set("sheet.columns", "7");
  EXPECT_EQ(picture.coloring, MeshColoring::kColors);
  EXPECT_EQ(sheet.columns, 7);
  EXPECT_THROW(fields.set("picture.supersampling", "0"), Error);
}

}  // namespace
}  // namespace ovimap
