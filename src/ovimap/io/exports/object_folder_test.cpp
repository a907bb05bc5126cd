// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/exports/object_folder.h"

#include <fstream>

#include <nlohmann/json.hpp>

#include "ovimap/io/map_file/map_file_fixture.h"
#include "ovimap/io/mesh/ply.h"

namespace ovimap {
namespace {

namespace fs = std::filesystem;

class ObjectFolder : public MapFolder {
 protected:
  ObjectFolder() {
    map_.instances.resize(2);
    map_.instances[0].id = 4;
    map_.instances[1].id = 9;
    map_.instances[0].super_points = {1, 3};
    map_.parts.resize(1);
    map_.parts[0].id = 3;
    map_.parts[0].super_points = {3};
    map_.names[4] = "Tea pot/../..\xc3\xa4 ";
    ObjectView view;
    view.visible_px = 7;
    view.frame = 3;
    view.crop.image_jpeg = encode_jpeg(RgbImage(2, 2), 90);
    view.crop.mask_png = encode_png(Image<std::uint16_t>(2, 2, 1));
    view.crop.object_px = {Eigen::Vector2i(0, 0), Eigen::Vector2i(1, 1)};
    map_.semantics.looks[1].views = {ObjectView{}, view};
    mesh_.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh_.labels = {4, 4, 4};
    mesh_.triangles = {{0, 1, 2}};
  }
  MapRecord map_;
  Mesh mesh_;
  const MeshParts parts_ = [this](const auto& visit) { visit(mesh_); };
  const std::vector<ObjectRelation> relations_ = {{4, Relation::kOn, 9, 0.75f, "there"}};
};

TEST_F(ObjectFolder, HasEverythingOfAnObject) {
  write_object_folder(root_ / "out", map_, {}, parts_, relations_, "{}");
  const fs::path pot = root_ / "out" / "4_Tea-pot";
  ASSERT_TRUE(fs::is_directory(pot));
  EXPECT_EQ(read_ply(pot / "mesh.ply").vertices.size(), 3u);
  const auto entry = nlohmann::json::parse(std::ifstream(pot / "object.json"));
  EXPECT_EQ(entry["id"], 4);
  EXPECT_EQ(entry["relations"][0]["anchor"], 9);
  EXPECT_EQ(entry["parts"][0]["name"], "part 1");
  ASSERT_EQ(entry["crops"].size(), 1u);
  EXPECT_EQ(entry["crops"][0]["frame"], 3);
  EXPECT_EQ(read_rgb(pot / std::string(entry["crops"][0]["file"])).width(), 2);
  EXPECT_EQ(read_gray(pot / std::string(entry["crops"][0]["mask"])).values.at(1, 1), 255);
  EXPECT_FALSE(fs::exists(root_ / "out" / "9" / "mesh.ply"));  // no surface
  EXPECT_TRUE(fs::exists(root_ / "out" / "9" / "object.json"));
  EXPECT_TRUE(fs::exists(root_ / "out" / "scene.json"));
  EXPECT_EQ(files_in_root(), 1u);
}

TEST_F(ObjectFolder, NeverMixesWithWhatIsThere) {
  fs::create_directories(root_ / "empty");
  write_object_folder(root_ / "empty/", map_, {}, parts_, {}, "{}");
  EXPECT_NE(fault_of([&] { check_new_folder(root_ / "empty"); }).find("not empty"),
            std::string::npos);
  std::ofstream(root_ / "file") << "x";
  EXPECT_NE(fault_of([&] { check_new_folder(root_ / "file"); }).find("no folder"),
            std::string::npos);
  EXPECT_NE(fault_of([&] { check_new_folder(root_ / "none" / "out"); }).find("create the folder"),
            std::string::npos);
}

}  // namespace
}  // namespace ovimap
