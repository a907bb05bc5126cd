// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/truth/truth.h"

#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "ovimap/base/error.h"
#include "ovimap/base/error_fixture.h"
#include "ovimap/base/temporary_folder_fixture.h"
#include "ovimap/io/mesh/ply.h"

namespace ovimap {
namespace {

namespace fs = std::filesystem;

/// A scene "den" with a mesh of four vertices, in a folder of its own that goes with the test.
class TruthFolder : public ::testing::Test {
 protected:
  TruthFolder() {
    fs::create_directories(root_ / "den");
    Mesh mesh;
    mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    mesh.triangles = {{0, 1, 2}};
    write_ply(root_ / "den_mesh.ply", mesh);
    write("instance_labels_den.txt", "12\n12\n-1\n3\n");
    write("semantic_labels_den.txt", "1\r\n1\r\n0.0\r\n4.0e+00");
  }
  void write(const std::string& name, const std::string& text) {
    std::ofstream(root_ / name) << text;
  }

  std::string fault() const {
    return error_of([&] { load_truth(root_ / "den"); });
  }

  bool fault_names(const std::string& part) const {
    return fault().find(part) != std::string::npos;
  }

  const fixture::TemporaryFolder folder_;
  const fs::path root_ = folder_.path();
};

TEST_F(TruthFolder, LoadsMeshLabelsAndNames) {
  write("labels.json", R"({"instances": {"12": "sofa", "3": "wall"}, "classes": {"1": "couch"}})");
  const Truth truth = load_truth(root_ / "den" / "");
  EXPECT_EQ(truth.mesh.vertices.size(), 4u);
  EXPECT_EQ(truth.instances, (std::vector<std::int32_t>{12, 12, -1, 3}));
  EXPECT_EQ(truth.classes, (std::vector<std::int32_t>{1, 1, 0, 4}));
  EXPECT_EQ(truth.instance_names.at(12), "sofa");
  EXPECT_EQ(truth.class_names.at(1), "couch");
}

TEST_F(TruthFolder, ThingsMayBeNamedThatAreNotScored) {
  write("labels.json", R"({"instances": {"12": "pen", "3": "wall"}, "unscored": [12]})");
  EXPECT_EQ(load_truth(root_ / "den").unscored, std::set<std::int32_t>{12});
  write("labels.json", R"({"instances": {"12": "pen"}, "unscored": {"12": true}})");
  EXPECT_TRUE(fault_names("labels.json"));
  write("labels.json", R"({"instances": {"12": "pen"}})");
  EXPECT_TRUE(load_truth(root_ / "den").unscored.empty());
}

TEST_F(TruthFolder, TheScenesOwnNamesGoFirst) {
  write("labels.json", R"({"instances": {"12": "sofa"}})");
  write("den/labels.json", R"({"instances": {"12": "bed"}})");
  const Truth truth = load_truth(root_ / "den");
  EXPECT_EQ(truth.instance_names.at(12), "bed");
  EXPECT_TRUE(truth.class_names.empty());
}

TEST_F(TruthFolder, ClassesAndNamesMayBeMissing) {
  fs::remove(root_ / "semantic_labels_den.txt");
  const Truth truth = load_truth(root_ / "den");
  EXPECT_TRUE(truth.classes.empty());
  EXPECT_TRUE(truth.instance_names.empty());
}

TEST_F(TruthFolder, MeshOfQuadsAsReplicaPublishesIt) {
  write("den_mesh.ply",
        "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\n"
        "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
        "element face 2\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 0 1 2 3\n1 0 0 1 2 3\n1 1 0 1 2 3\n0 1 0 1 2 3\n2 0 0 1 2 3\n2 1 0 1 2 3\n"
        "4 0 1 2 3\n4 1 4 5 2\n");
  write("instance_labels_den.txt", "7\n7\n7\n7\n9\n9\n");
  write("semantic_labels_den.txt", "93\n93\n93\n93\n-1\n256\n");
  const Truth truth = load_truth(root_ / "den");
  EXPECT_EQ(truth.mesh.vertices.size(), 6u);
  EXPECT_EQ(truth.mesh.triangles.size(), 4u);  // two for each quad
  EXPECT_EQ(truth.instances, (std::vector<std::int32_t>{7, 7, 7, 7, 9, 9}));
  EXPECT_EQ(truth.classes, (std::vector<std::int32_t>{93, 93, 93, 93, -1, 256}));
}

TEST_F(TruthFolder, NamesOfTheDataSetItself) {
  fs::create_directories(root_ / "den" / "habitat");
  write("den/habitat/info_semantic.json",
        R"({"classes": [{"id": 1, "name": "backpack"}, {"id": 93, "name": "wall"}],
            "objects": [{"id": 12, "class_id": 93, "class_name": "wall"}]})");
  const Truth truth = load_truth(root_ / "den");
  EXPECT_EQ(truth.class_names.at(93), "wall");
  EXPECT_EQ(truth.instance_names.at(12), "wall");
  write("labels.json", R"({"instances": {"12": "sofa"}})");
  EXPECT_EQ(load_truth(root_ / "den").instance_names.at(12), "sofa");
  fs::remove(root_ / "labels.json");
  write("den/habitat/info_semantic.json", R"({"classes": [{"id": "one"}]})");
  EXPECT_TRUE(fault_names("is not Replica's info_semantic.json")) << fault();
}

TEST_F(TruthFolder, NamesWhatIsMissing) {
  EXPECT_THROW(load_truth(root_ / "attic"), Error);
  fs::remove(root_ / "instance_labels_den.txt");
  EXPECT_TRUE(fault_names("instance_labels_den.txt")) << fault();
  fs::remove(root_ / "den_mesh.ply");
  EXPECT_TRUE(fault_names("den_mesh.ply")) << fault();
}

TEST_F(TruthFolder, RefusesLabelsOfAnotherMesh) {
  write("instance_labels_den.txt", "12\n12\n3\n");
  EXPECT_TRUE(fault_names("has 3 labels, but its mesh has 4 vertices")) << fault();
  write("instance_labels_den.txt", "1 1 1 1");
  write("semantic_labels_den.txt", "");
  EXPECT_TRUE(fault_names("semantic_labels_den.txt' has 0 labels")) << fault();
}

TEST_F(TruthFolder, RefusesLabelsThatAreNoWholeNumbers) {
  for (const char* entry : {"1.5", "sofa", "1e30", "nan", "3000000000"}) {
    write("instance_labels_den.txt", std::string("1\n1\n") + entry + "\n1\n");
    EXPECT_TRUE(fault_names("entry 3 is no whole number")) << entry << ": " << fault();
  }
}

TEST_F(TruthFolder, RefusesAMeshWithoutVertices) {
  write_ply(root_ / "den_mesh.ply", Mesh{});
  EXPECT_TRUE(fault_names("has no vertices")) << fault();
}

TEST_F(TruthFolder, RefusesBrokenNames) {
  for (const char* text : {"[1]", R"({"instances": {"sofa": "12"}})", R"({"classes": {"1": 2}})"}) {
    write("labels.json", text);
    EXPECT_TRUE(fault_names("is not of the form")) << text;
  }
  write("labels.json", "{");
  EXPECT_TRUE(fault_names("labels.json is not JSON")) << fault();
  write("labels.json", R"({"instances": {"1": "sofa", "1": "bed"}})");
  EXPECT_TRUE(fault_names("twice")) << fault();
}

}  // namespace
}  // namespace ovimap
