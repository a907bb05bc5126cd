// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/mesh/mesh_pieces.h"

#include <gtest/gtest.h>

#include "ovimap/base/temporary_folder_fixture.h"
#include "ovimap/io/mesh/labelled_pieces.h"

namespace ovimap {
namespace {

/// A strip of four triangles, of which the first two belong to 5, the third mostly to 7.
Mesh strip() {
  Mesh mesh;
  for (int i = 0; i < 6; ++i) {
    mesh.vertices.emplace_back(static_cast<float>(i / 2), static_cast<float>(i % 2), 0.f);
    mesh.colors.push_back({static_cast<std::uint8_t>(i), 0, 0});
  }
  mesh.labels = {5, 5, 5, 7, 7, 0};
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {2, 4, 3}, {5, 4, 2}};
  return mesh;
}

TEST(MeshPieces, EveryTriangleIsInOnePiece) {
  const auto pieces = split_by_label(strip());
  ASSERT_EQ(pieces.size(), 3u);
  EXPECT_EQ(pieces.at(5).triangles.size(), 2u);
  EXPECT_EQ(pieces.at(5).vertices.size(), 4u);
  ASSERT_EQ(pieces.at(7).triangles.size(), 1u);
  EXPECT_EQ(pieces.at(7).vertices.size(), 3u);
  EXPECT_EQ(pieces.at(7).vertices[pieces.at(7).triangles[0][1]], Eigen::Vector3f(2, 0, 0));
  EXPECT_EQ(pieces.at(7).colors[pieces.at(7).triangles[0][2]][0], 3);
  ASSERT_EQ(pieces.at(0).triangles.size(), 1u);  // three labels: the first corner's
  EXPECT_TRUE(pieces.at(0).normals.empty());
}

TEST(MeshPieces, LabelsCanBeLeftOut) {
  const Mesh kept = without_labels(strip(), [](std::uint32_t label) { return label == 5; });
  EXPECT_EQ(kept.triangles.size(), 2u);
  EXPECT_EQ(kept.vertices.size(), 4u);
  EXPECT_EQ(kept.colors.size(), 4u);
  EXPECT_TRUE(without_labels(Mesh{}, [](std::uint32_t) { return false; }).vertices.empty());
}

TEST(LabelledPieces, AreThoseOfTheWholeMesh) {
  Mesh above = strip();
  for (Eigen::Vector3f& vertex : above.vertices) vertex.z() += 1.f;
  const fixture::TemporaryFolder folder;
  const LabelledPieces pieces(
      [&](const auto& visit) {
        visit(strip());
        visit(above);
      },
      folder.path() / "pieces");
  Mesh both = strip();
  append(above, both);
  const auto expected = split_by_label(both);
  for (const std::uint32_t label : {0u, 5u, 7u}) {
    const Mesh piece = pieces.piece(label);
    EXPECT_EQ(piece.vertices, expected.at(label).vertices) << label;
    EXPECT_EQ(piece.colors, expected.at(label).colors) << label;
    EXPECT_EQ(piece.labels, expected.at(label).labels) << label;
    EXPECT_EQ(piece.triangles, expected.at(label).triangles) << label;
  }
  EXPECT_TRUE(pieces.piece(6).vertices.empty());
}

}  // namespace
}  // namespace ovimap
