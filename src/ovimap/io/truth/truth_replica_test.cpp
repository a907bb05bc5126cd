// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/truth/truth_replica.h"

#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "ovimap/base/error_fixture.h"
#include "ovimap/base/temporary_folder_fixture.h"

namespace ovimap {
namespace {

namespace fs = std::filesystem;
using TrueIds = std::vector<std::int32_t>;

/// ROOT/room0 without labels of its own, and Replica's annotation of it in ROOT/room_0/habitat: two
/// quads of object 4 and one of object 9, which touch along an edge, and one that is unlabelled.
class ReplicaTruth : public ::testing::Test {
 protected:
  ReplicaTruth() {
    fs::create_directories(root_ / "room0");
    fs::create_directories(root_ / "room_0" / "habitat");
    write("room_0/habitat/mesh_semantic.ply", mesh_text("object_id"));
    write("room_0/habitat/info_semantic.json",
          R"({"classes": [{"id": 76, "name": "sofa"}, {"id": 93, "name": "wall"}],
              "id_to_label": [-2, 0, 0, 0, 93, 0, 0, 0, 0, 76],
              "objects": [{"id": 4, "class_id": 93, "class_name": "wall"},
                          {"id": 9, "class_id": 76, "class_name": "sofa"},
                          {"id": 0, "class_id": -1, "class_name": "undefined"}]})");
  }
  /// Ten vertices in two rows; quad k has the columns k and k + 1.
  static std::string mesh_text(const std::string& property) {
    std::string text =
        "ply\nformat ascii 1.0\nelement vertex 10\nproperty float x\nproperty float y\n"
        "property float z\nelement face 4\nproperty list uchar int vertex_indices\n"
        "property int " +
        property + "\nend_header\n";
    for (const char* row : {" 0 0\n", " 1 0\n"})
      for (int column = 0; column < 5; ++column) text += std::to_string(column) + row;
    return text + "4 0 1 6 5 4\n4 1 2 7 6 4\n4 2 3 8 7 9\n4 3 4 9 8 0\n";
  }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(root_ / name) << text;
  }
  std::string fault() const {
    return error_of([&] { load_truth(root_ / "room0"); });
  }

  const fixture::TemporaryFolder folder_;
  const fs::path root_ = folder_.path();
};

TEST_F(ReplicaTruth, VerticesTakeTheObjectOfMostTriangles) {
  const Truth truth = load_truth(root_ / "room0");
  EXPECT_EQ(truth.mesh.vertices.size(), 10u);
  EXPECT_EQ(truth.mesh.triangles.size(), 8u);  // two for each quad
  // Quads are cut from their first corner: vertex 2 has one triangle of object 4 and two of object
  // 9; vertex 3 one of object 9 and two of object 0; 7 and 8 have two and one.
  EXPECT_EQ(truth.instances, (TrueIds{4, 4, 9, 0, 0, 4, 4, 4, 9, 0}));
  EXPECT_EQ(truth.classes, (TrueIds{93, 93, 76, 0, 0, 93, 93, 93, 76, 0}));
  EXPECT_EQ(truth.class_names.at(76), "sofa");
  EXPECT_EQ(truth.instance_names.at(9), "sofa");
}

TEST_F(ReplicaTruth, IsFoundInTheScenesOwnFolderFirst) {
  fs::create_directories(root_ / "room0" / "habitat");
  EXPECT_EQ(find_replica_semantic_mesh(root_ / "room0"),
            root_ / "room_0" / "habitat" / "mesh_semantic.ply");
  write("room0/habitat/mesh_semantic.ply", "");
  EXPECT_EQ(find_replica_semantic_mesh(root_ / "room0"),
            root_ / "room0" / "habitat" / "mesh_semantic.ply");
}

TEST_F(ReplicaTruth, PublishedLabelsOfThePackGoFirst) {
  fs::copy_file(root_ / "room_0" / "habitat" / "mesh_semantic.ply", root_ / "room0_mesh.ply");
  fs::create_directories(root_ / "replica_gt_instances");
  fs::create_directories(root_ / "replica_gt_semantics");
  write("replica_gt_instances/instance_labels_room0.txt", "1 1 1 1 1 2 2 2 2 2");
  write("replica_gt_semantics/semantic_labels_room0.txt", "93 93 93 93 93 76 76 76 256 -1");
  const Truth truth = load_truth(root_ / "room0");
  EXPECT_EQ(truth.instances, (TrueIds{1, 1, 1, 1, 1, 2, 2, 2, 2, 2}));
  EXPECT_EQ(truth.classes, (TrueIds{93, 93, 93, 93, 93, 76, 76, 76, 0, -1})) << "256 is no class";
  EXPECT_EQ(truth.class_names.at(93), "wall");
}

TEST_F(ReplicaTruth, SaysWhatIsMissing) {
  fs::rename(root_ / "room_0" / "habitat" / "info_semantic.json", root_ / "away.json");
  EXPECT_NE(fault().find("info_semantic.json', which names its objects"), std::string::npos)
      << fault();
  fs::rename(root_ / "away.json", root_ / "room_0" / "habitat" / "info_semantic.json");
  write("room_0/habitat/mesh_semantic.ply", mesh_text("shade"));
  EXPECT_NE(fault().find("no property 'object_id'"), std::string::npos) << fault();
  write("room_0/habitat/info_semantic.json", R"({"classes": []})");
  write("room_0/habitat/mesh_semantic.ply", mesh_text("object_id"));
  EXPECT_NE(fault().find("is not Replica's info_semantic.json"), std::string::npos) << fault();
}

}  // namespace
}  // namespace ovimap
