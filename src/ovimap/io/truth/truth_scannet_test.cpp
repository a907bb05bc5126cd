// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/truth/truth_scannet.h"

#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "ovimap/base/error_fixture.h"
#include "ovimap/base/temporary_folder_fixture.h"
#include "ovimap/io/mesh/ply.h"

namespace ovimap {
namespace {

namespace fs = std::filesystem;
using TrueIds = std::vector<std::int32_t>;

/// ROOT/scans/scene0001_00 with a mesh of six vertices, and the table in ROOT.
class ScanNetTruth : public ::testing::Test {
 protected:
  ScanNetTruth() {
    fs::create_directories(scene_);
    Mesh mesh;
    for (int i = 0; i < 6; ++i) mesh.vertices.push_back({float(i), 0, float(i % 2)});
    mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
    mesh.labels = {5, 5, 1, 1, 40, 0};  // NYU40 ids, as the published mesh has them
    write_ply(scene_ / "scene0001_00_vh_clean_2.labels.ply", mesh);
    write("scene0001_00_vh_clean_2.0.010000.segs.json",
          R"({"sceneId": "scene0001_00", "segIndices": [70, 70, 3, 9, 12, 500]})");
    write("scene0001_00.aggregation.json", R"({"sceneId": "scannet.scene0001_00", "segGroups": [
        {"id": 0, "objectId": 0, "segments": [70], "label": "office chair"},
        {"id": 1, "objectId": 1, "segments": [3, 9], "label": "wall"},
        {"id": 4, "objectId": 4, "segments": [12], "label": "odd thing"}]})");
    write("../../scannetv2-labels.combined.tsv",
          "id\traw_category\tcategory\tcount\tnyu40id\teigen13id\tnyuClass\tnyu40class\r\n"
          "1\twall\twall\t8277\t1\t12\twall\twall\r\n"
          "10\toffice chair\toffice chair\t595\t5\t4\tchair\tchair\r\n"
          "1299\todd thing\tobject\t1\t40\t7\tobject\totherprop\r\n");
  }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(scene_ / name) << text;
  }
  std::string fault() const {
    return error_of([&] { load_truth(scene_); });
  }
  bool fault_names(const std::string& part) const {
    return fault().find(part) != std::string::npos;
  }

  const fixture::TemporaryFolder folder_;
  const fs::path root_ = folder_.path();
  const fs::path scene_ = root_ / "scans" / "scene0001_00";
};

TEST_F(ScanNetTruth, InstancesAreObjectsCountedFromOne) {
  const Truth truth = load_truth(scene_);
  EXPECT_EQ(truth.mesh.vertices.size(), 6u);
  EXPECT_TRUE(truth.mesh.labels.empty());
  EXPECT_EQ(truth.instances, (TrueIds{1, 1, 2, 2, 5, 0}));
  EXPECT_EQ(truth.instance_names.size(), 3u);
  EXPECT_EQ(truth.instance_names.at(1), "office chair");
  EXPECT_EQ(truth.instance_names.at(5), "odd thing");
}

TEST_F(ScanNetTruth, ThreeNumberingsOfClasses) {
  const Truth benchmark = load_truth(scene_, ScanNetClasses::kScanNet200);
  EXPECT_EQ(benchmark.classes, (TrueIds{10, 10, 1, 1, 0, 0}));
  EXPECT_EQ(benchmark.class_names,
            (std::map<std::int32_t, std::string>{{1, "wall"}, {10, "office chair"}}));
  const Truth nyu40 = load_truth(scene_, ScanNetClasses::kNyu40);
  EXPECT_EQ(nyu40.classes, (TrueIds{5, 5, 1, 1, 40, 0}));
  EXPECT_EQ(nyu40.class_names.at(5), "chair");
  EXPECT_EQ(nyu40.class_names.at(40), "otherprop");
  const Truth raw = load_truth(scene_, ScanNetClasses::kRaw);
  EXPECT_EQ(raw.classes, (TrueIds{10, 10, 1, 1, 1299, 0}));
  EXPECT_EQ(raw.class_names.at(1299), "odd thing");
}

TEST_F(ScanNetTruth, IsFoundFromAnExportedFolderAndASensFile) {
  fs::create_directories(scene_ / "exported");
  EXPECT_EQ(load_truth(scene_ / "exported").instances, (TrueIds{1, 1, 2, 2, 5, 0}));
  write("scene0001_00.sens", "");
  EXPECT_EQ(load_truth(scene_ / "scene0001_00.sens").instances, (TrueIds{1, 1, 2, 2, 5, 0}));
}

TEST_F(ScanNetTruth, MeshWithoutLabelsWillDo) {
  fs::rename(scene_ / "scene0001_00_vh_clean_2.labels.ply", scene_ / "scene0001_00_vh_clean_2.ply");
  EXPECT_EQ(load_truth(scene_, ScanNetClasses::kNyu40).classes, (TrueIds{5, 5, 1, 1, 40, 0}));
}

TEST_F(ScanNetTruth, LaterObjectHasASharedSegment) {
  write("scene0001_00.aggregation.json", R"({"segGroups": [
      {"objectId": 0, "segments": [70, 3], "label": "wall"},
      {"objectId": 1, "segments": [3], "label": "office chair"}]})");
  EXPECT_EQ(load_truth(scene_).instances, (TrueIds{1, 1, 2, 0, 0, 0}));
}

TEST_F(ScanNetTruth, WhatIsMissingIsNamed) {
  fs::remove(root_ / "scannetv2-labels.combined.tsv");
  EXPECT_TRUE(fault_names("lacks scannetv2-labels.combined.tsv")) << fault();
  fs::remove(scene_ / "scene0001_00.aggregation.json");
  EXPECT_TRUE(fault_names("scene0001_00.aggregation.json'; it should lie")) << fault();
  fs::remove(scene_ / "scene0001_00_vh_clean_2.0.010000.segs.json");
  EXPECT_TRUE(fault_names("scene0001_00_vh_clean_2.0.010000.segs.json'")) << fault();
  fs::remove(scene_ / "scene0001_00_vh_clean_2.labels.ply");
  EXPECT_TRUE(fault_names("scene0001_00_mesh.ply")) << fault();
}

TEST_F(ScanNetTruth, WhatDoesNotFitIsNamed) {
  write("scene0001_00_vh_clean_2.0.010000.segs.json", R"({"segIndices": [1, 2]})");
  EXPECT_TRUE(fault_names("has 2 vertices, but its mesh has 6")) << fault();
  write("scene0001_00_vh_clean_2.0.010000.segs.json", R"({"segIndices": [1, 2, 1, 2, 1, 2]})");
  EXPECT_TRUE(fault_names("not of the same scene")) << fault();
  write("scene0001_00_vh_clean_2.0.010000.segs.json", R"({"segIndices": [70, 2, 1, 2, 1, 2]})");
  write("scene0001_00.aggregation.json",
        R"({"segGroups": [{"objectId": 0, "segments": [70], "label": "spaceship"}]})");
  EXPECT_TRUE(fault_names("has no row for the name 'spaceship'")) << fault();
  write("scene0001_00.aggregation.json", R"({"segGroups": [{"segments": [70]}]})");
  EXPECT_TRUE(fault_names("aggregation.json' is not of the form")) << fault();
  write("scene0001_00_vh_clean_2.0.010000.segs.json", "[]");
  EXPECT_TRUE(fault_names("segs.json' is not of the form")) << fault();
}

TEST_F(ScanNetTruth, BrokenTablesAreNamed) {
  const std::string table = "../../scannetv2-labels.combined.tsv";
  write(table, "");
  EXPECT_TRUE(fault_names("has no column 'id'")) << fault();
  write(table, "id\traw_category\n1\twall\n");
  EXPECT_TRUE(fault_names("has no column 'nyu40id'")) << fault();
  write(table, "id\traw_category\tnyu40id\tnyu40class\n1\twall\n");
  EXPECT_TRUE(fault_names("line 2 has 2 columns")) << fault();
  write(table, "id\traw_category\tnyu40id\tnyu40class\n1\twall\tone\twall\n");
  EXPECT_TRUE(fault_names("line 2: 'one' is no whole number")) << fault();
}

TEST_F(ScanNetTruth, OneSceneAtATime) {
  fs::copy_file(scene_ / "scene0001_00_vh_clean_2.labels.ply",
                scene_ / "scene0001_01_vh_clean_2.labels.ply");
  EXPECT_TRUE(fault_names("holds the truth of 2 scenes")) << fault();
}

}  // namespace
}  // namespace ovimap
