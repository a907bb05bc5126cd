// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/procedural/made_model.h"

#include <set>

#include <gtest/gtest.h>

#include "ovimap/base/error.h"
#include "ovimap/synth/furniture/furniture_palette.h"
#include "ovimap/synth/shapes/mesh_parts.h"

namespace ovimap {
namespace {

class MadeKind : public testing::TestWithParam<std::string> {};

TEST_P(MadeKind, IsAWholeThingOfEitherSplit) {
  for (const Split split : {Split::kTuned, Split::kUnseen}) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      Random random(seed), again(seed);
      const MadeModel model = make_model(GetParam(), split, random);
      EXPECT_GT(room_class_id(model.class_name), 0u);
      const TexturedMesh& mesh = model.mesh;
      ASSERT_FALSE(mesh.triangles.empty());
      ASSERT_EQ(mesh.normals.size(), mesh.vertices.size());
      ASSERT_EQ(mesh.uvs.size(), mesh.vertices.size());
      ASSERT_EQ(mesh.triangle_materials.size(), mesh.triangles.size());
      for (const Eigen::Vector3f& normal : mesh.normals) ASSERT_NEAR(normal.norm(), 1, 1e-3f);
      for (const std::uint32_t material : mesh.triangle_materials)
        ASSERT_LT(material, mesh.materials.size());
      const Eigen::AlignedBox3f box = bounds(mesh);
      EXPECT_NEAR(box.min().z(), 0, 1e-4f);
      EXPECT_NEAR(box.center().head<2>().norm(), 0, 1e-4f);
      EXPECT_GT(box.sizes().maxCoeff(), 0.03f);
      EXPECT_LT(box.sizes().maxCoeff(), 2.7f);
      for (const Deck& deck : model.decks) {
        EXPECT_GT(deck.half_m.minCoeff(), 0);
        EXPECT_LE(deck.height_m, box.max().z() + 1e-4f);
        EXPECT_LE((deck.center_m + deck.half_m - box.max().head<2>()).maxCoeff(), 1e-3f);
        EXPECT_GE((deck.center_m - deck.half_m - box.min().head<2>()).minCoeff(), -1e-3f);
      }
      EXPECT_EQ(make_model(GetParam(), split, again).mesh.vertices, mesh.vertices);
    }
  }
}

std::string spelled(const testing::TestParamInfo<std::string>& kind) {
  std::string name = kind.param;
  for (char& c : name)
    if (c == ' ') c = '_';
  return name;
}

INSTANTIATE_TEST_SUITE_P(Every, MadeKind, testing::ValuesIn(made_kinds()), spelled);

TEST(MadeModelTest, SaysWhatMostOfAThingIsMadeOf) {
  std::set<std::string> of_tables;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Random random(seed);
    of_tables.insert(main_substance(make_model("table", Split::kUnseen, random).mesh));
  }
  EXPECT_EQ(of_tables, (std::set<std::string>{"lacquer", "wood"}));
  EXPECT_EQ(main_substance({}), "");
}

TEST(MadeModelTest, AnUnknownKindIsSaid) {
  Random random(1);
  EXPECT_THROW(make_model("sofaa", Split::kTuned, random), Error);
}

}  // namespace
}  // namespace ovimap
