// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <set>

#include <gtest/gtest.h>

#include "ovimap/synth/buildings/room_builder.h"
#include "ovimap/synth/furniture/furniture_catalog.h"
#include "ovimap/synth/furniture/furniture_palette.h"
#include "ovimap/synth/shapes/mesh_parts.h"
#include "ovimap/synth/shapes/soft_models.h"

namespace ovimap {
namespace {

std::size_t pieces_asked_for(const RoomSpec& spec) {
  std::size_t pieces = 0;
  for (const FurnitureRequest& request : spec.furniture)
    pieces += static_cast<std::size_t>(request.count);
  return pieces;
}

class RoomsV1 : public testing::TestWithParam<std::string> {};

TEST_P(RoomsV1, HoldsTwentyFiveThingsOfKnownClasses) {
  if (!std::filesystem::exists(default_furniture_folder()))
    GTEST_SKIP() << "the Debian package sweethome3d-furniture is not installed";
  const RoomSpec spec = room_spec(GetParam());
  EXPECT_EQ(spec.camera.width, 640);
  EXPECT_EQ(spec.frames, 200);
  const SynthRoom room = build_room(spec);
  std::size_t furniture = 0;
  std::set<std::string> classes;
  for (const RoomObject& object : room.objects) {
    EXPECT_GT(room_class_id(object.class_name), 0u);
    const bool shell = object.class_name == "wall" || object.class_name == "floor" ||
                       object.class_name == "ceiling";
    furniture += shell ? 0 : 1;
    classes.insert(object.class_name);
  }
  EXPECT_GE(furniture, 25u);
  EXPECT_GE(classes.size(), 20u);
  // The best of the layouts tried has room for all but a thing or two.
  EXPECT_GE(furniture + 2, pieces_asked_for(spec));
}

INSTANTIATE_TEST_SUITE_P(EveryRoom, RoomsV1, testing::ValuesIn(rooms_v1_names()),
                         [](const auto& room) {
                           std::string name = room.param;
                           std::erase(name, '-');
                           return name;
                         });

TEST(RoomModels, AreDrawnFromTheChoiceAndOtherPiecesAreLeftOut) {
  if (!std::filesystem::exists(default_furniture_folder()))
    GTEST_SKIP() << "the Debian package sweethome3d-furniture is not installed";
  RoomSpec spec = room_spec("office");
  spec.models = {{"desk", {"BlendSwap-CC-0/lbDesk"}}, {"office chair", {"Scopia/office_chair"}}};
  std::set<std::string> with_maker, classes;
  for (const RoomObject& object : build_room(spec).objects) {
    classes.insert(object.class_name);
    if (!object.source.empty()) with_maker.insert(object.source);
  }
  EXPECT_EQ(with_maker.size(), 2u) << "two models of the catalogue";
  EXPECT_TRUE(classes.contains("desk") && classes.contains("office chair"));
  EXPECT_TRUE(classes.contains("picture")) << "made up, so no model of it is needed";
}

TEST(SoftModels, FillTheirSizeWithOutwardNormals) {
  const Eigen::Vector3f size(0.5f, 0.4f, 0.14f);
  for (const TexturedMesh& mesh : {pillow_model(size, 3), blanket_model(size, 3)}) {
    const auto box = bounds(mesh);
    EXPECT_NEAR(box.sizes().x(), size.x(), 1e-5f);
    EXPECT_NEAR(box.sizes().y(), size.y(), 1e-5f);
    EXPECT_GE(box.min().z(), 0);
    EXPECT_LE(box.max().z(), size.z() + 1e-5f);
    EXPECT_GT(box.max().z(), size.z() * 0.6f);
    ASSERT_EQ(mesh.normals.size(), mesh.vertices.size());
    for (const Eigen::Vector3f& normal : mesh.normals) EXPECT_NEAR(normal.norm(), 1, 1e-4f);
  }
}

}  // namespace
}  // namespace ovimap
