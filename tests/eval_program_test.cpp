// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// Evaluation as a user meets it.
#include "truth_fixture.h"

namespace ovimap {
namespace {

class EvalProgramTest : public TruthfulProgramTest {
 protected:
  const std::string kEncoder = " --encoder " + golden_model("minilm");
  static constexpr const char* kEval = "eval room.ovimap --gt replica/scene";
};

TEST_F(EvalProgramTest, ScoresInstancesAndClassesInBothProtocols) {
  make_map(golden_model("minilm"));
  const auto scores = run_json(kEval + kEncoder + " --json --markdown tables.md");
  EXPECT_EQ(scores["standard"]["class_agnostic"]["ap"], 1.0);
  // Two surfaces may have vertices in one place, of which either may be found.
  EXPECT_NEAR(scores["standard"]["class_agnostic"]["miou"].get<double>(), 1.0, 1e-4);
  EXPECT_EQ(scores["standard"]["geometry"]["completeness"], 1.0);
  for (const char* protocol : {"standard", "reference"}) {
    const auto& semantic = scores[protocol]["semantic"];
    EXPECT_EQ(semantic["class_set"], "truth");
    EXPECT_EQ(semantic["classes"], 3);
    for (const char* figure : {"miou", "macc", "fwiou", "ap25", "ap50", "ap"}) {
      EXPECT_GE(semantic[figure].get<double>(), 0) << figure;
      EXPECT_LE(semantic[figure].get<double>(), 1) << figure;
    }
    EXPECT_GE(semantic["aq"].get<double>(), 1);
    EXPECT_EQ(scores["scenes"]["room.ovimap"][protocol]["semantic"]["miou"], semantic["miou"]);
  }
  EXPECT_TRUE(scores["standard"]["semantic"].contains("pq"));
  EXPECT_FALSE(scores["reference"]["semantic"].contains("pq"));
  const std::string tables = slurp(path("tables.md"));
  EXPECT_NE(tables.find("| all | standard | 1.000 |"), std::string::npos) << tables;
  EXPECT_NE(tables.find("mAcc"), std::string::npos);
}

TEST_F(EvalProgramTest, ProtocolsAndClassSetsCanBeChosen) {
  make_map(golden_model("minilm"));
  const auto one = run_json(kEval + kEncoder + " --json --protocol standard --classes scannet200");
  EXPECT_FALSE(one.contains("reference"));
  EXPECT_EQ(one["standard"]["semantic"]["class_set"], "scannet200");
  EXPECT_EQ(one["standard"]["semantic"]["classes"], 2);  // it knows no teapots
  EXPECT_TRUE(one["standard"]["semantic"]["groups"].contains("tail"));
  EXPECT_NE(one["notices"][0].get<std::string>().find("teapot"), std::string::npos);
  expect_complaint(kEval + kEncoder + " --protocol best", {"best"});
  expect_complaint(kEval + kEncoder + " --classes birds", {"birds", "replica51"});
}

TEST_F(EvalProgramTest, ReferenceScoresWallsOfScanNetAsTheReleasedCodeDoes) {
  make_map(golden_model("minilm"));
  const auto figures_of_walls = [&](const char* classes) {
    const auto scores = run_json(kEval + kEncoder + " --json --classes " + classes);
    for (const auto& scored : scores["reference"]["semantic"]["per_class"])
      if (scored["name"] == "wall") return !scored["ap50"].is_null();
    return false;
  };
  EXPECT_TRUE(figures_of_walls("scannet200"));
  EXPECT_FALSE(figures_of_walls("replica51"));
}

TEST_F(EvalProgramTest, ScenesArePooled) {
  make_map(golden_model("minilm"));
  std::filesystem::copy_file(path("room.ovimap"), path("again.ovimap"));
  const auto scores =
      run_json("eval room.ovimap again.ovimap --gt replica/scene replica/scene --json" + kEncoder);
  const auto alone = run_json(kEval + kEncoder + " --json");
  EXPECT_EQ(scores["scenes"].size(), 2u);
  EXPECT_EQ(scores["standard"]["class_agnostic"]["truth_instances"].get<int>(),
            2 * alone["standard"]["class_agnostic"]["truth_instances"].get<int>());
  for (const char* figure : {"miou", "macc", "fwiou", "pq", "aq"})
    EXPECT_NEAR(scores["standard"]["semantic"][figure].get<double>(),
                alone["standard"]["semantic"][figure].get<double>(), 1e-12)
        << figure;
  expect_complaint("eval room.ovimap again.ovimap --gt replica/scene", {"2 maps", "1 truths"});
}

TEST_F(EvalProgramTest, WithoutEmbeddingsThereAreNoSemanticFigures) {
  make_map("none");
  const ProgramResult result = run(std::string(kEval) + " --json");
  EXPECT_EQ(result.code, 0);
  EXPECT_NE(result.err.find("no embeddings"), std::string::npos) << result.err;
  const auto scores = nlohmann::json::parse(result.out);
  EXPECT_FALSE(scores["standard"].contains("semantic"));
  EXPECT_EQ(scores["reference"]["class_agnostic"]["ap50"], 1.0);
}

TEST_F(EvalProgramTest, ScoresASurfaceOfAnyProgram) {
  make_map("none");
  ASSERT_EQ(run("export room.ovimap other.ply").code, 0);
  const auto map = run_json(std::string(kEval) + " --json")["standard"];
  const auto surface = run_json("eval other.ply --gt replica/scene --json")["standard"];
  EXPECT_EQ(surface["geometry"], map["geometry"]);
  EXPECT_EQ(surface["class_agnostic"], map["class_agnostic"]);
  Mesh mesh = read_ply(path("other.ply"));
  mesh.labels.clear();
  write_ply(path("plain.ply"), mesh);
  const auto plain = run_json("eval plain.ply --gt replica/scene --json")["standard"];
  EXPECT_EQ(plain["geometry"], map["geometry"]);
  EXPECT_EQ(plain["class_agnostic"]["ap50"], 0.0);
  write_text(path("broken.ply"), "ply\nformat ascii 1.0\nend_header\n");
  expect_complaint("eval broken.ply --gt replica/scene", {"broken.ply"});
}

TEST_F(EvalProgramTest, SaysHowTruthAndMapDisagree) {
  make_map("none");
  move_truth(1000 * Eigen::Matrix3f::Identity());
  expect_complaint(kEval, {"room.ovimap", "replica/scene", "1000 times"});
  Eigen::Matrix3f y_up;
  y_up << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  move_truth(y_up);
  expect_complaint(kEval, {"x, z, -y"});
  Mesh elsewhere;  // nothing like the room
  elsewhere.vertices = {{300, 300, 300}, {300, 301, 300}, {301, 300, 307}};
  elsewhere.labels = {1, 2, 3};
  write_truth(elsewhere);
  expect_complaint(kEval, {"do not overlap"});
}

TEST_F(EvalProgramTest, SaysWhatIsWrongWithTheLabels) {
  make_map(golden_model("minilm"));
  write_text(path("replica/labels.json"), R"({"classes": {"1": "wall", "2": "sofa"}})");
  expect_complaint(kEval + kEncoder, {"class id 3", "labels.json"});
  std::filesystem::remove(path("replica/labels.json"));
  EXPECT_NE(run(kEval + kEncoder).err.find("--classes"), std::string::npos);
  expect_complaint(kEval + kEncoder + " --classes replica51", {"class id", "replica51"});
  std::filesystem::remove(path("replica/semantic_labels_scene.txt"));
  EXPECT_EQ(run(kEval + kEncoder).code, 0);
  expect_complaint(kEval + kEncoder + " --classes scannet20", {"semantic_labels"});
  std::filesystem::remove(path("replica/instance_labels_scene.txt"));
  expect_complaint(kEval, {"instance_labels_scene.txt"});
}

TEST_F(EvalProgramTest, TakesTruthMeshesOfPolygons) {
  make_map("none");
  // The same vertices with one face of five corners.
  const Mesh mesh = read_ply(path("truth.ply"));
  std::string text = concat("ply\nformat ascii 1.0\nelement vertex ", mesh.vertices.size(),
                            "\nproperty float x\nproperty float y\nproperty float z\n",
                            "element face 1\nproperty list uchar int vertex_indices\nend_header\n");
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    text += concat(vertex.x(), " ", vertex.y(), " ", vertex.z(), "\n");
  write_text(path("replica/scene_mesh.ply"), text + "5 0 1 2 3 4\n");
  EXPECT_EQ(run_json(std::string(kEval) + " --json")["standard"]["class_agnostic"]["ap50"], 1.0);
}

}  // namespace
}  // namespace ovimap
