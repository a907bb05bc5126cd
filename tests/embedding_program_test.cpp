// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// Embeddings as a user meets them.
#include "ovimap/inference/encoders/image_text_encoder.h"
#include "ovimap/io/map_file/map_file.h"
#include "program_fixture.h"

namespace ovimap {
namespace {

using EmbeddingProgramTest = EncodedProgramTest;

TEST_F(EmbeddingProgramTest, MakesOldMapsSearchable) {
  map_with("none");
  expect_complaint("query room.ovimap mug --encoder " + golden_model("minilm"), {"reembed"});
  const auto report = run_json("reembed room.ovimap --json --encoder " + golden_model("minilm"));
  EXPECT_GT(report["instances"], 0);
  EXPECT_EQ(report["dimension"], 16);
  EXPECT_LE(run("query room.ovimap mug --encoder " + golden_model("minilm")).code, 1);
  // Another model's space: say so and offer the remedy.
  expect_complaint("query room.ovimap mug --encoder " + golden_model("clip"), {"reembed"});
}

TEST_F(EmbeddingProgramTest, AutoTakesThePreferredEncoderAndSaysWhereItIsTheSmallOne) {
  const auto install = [this](const std::string& golden, const std::string& name,
                              const std::string& keys) {
    const std::filesystem::path folder = path("models/" + name);
    std::filesystem::create_directories(path("models"));
    std::filesystem::copy(std::filesystem::path(OVIMAP_SOURCE_DIR) /
                              ("src/ovimap/inference/testdata/golden_" + golden),
                          folder, std::filesystem::copy_options::recursive);
    std::ofstream(folder / "model.yaml", std::ios::app) << "\n" << keys;
  };
  const auto encoder_of_run = [this] {
    const ProgramResult result =
        run(std::string("run replica/scene --masks gt -o room.ovimap --model-dir models") +
            kSmallPictures);
    EXPECT_EQ(result.code, 0) << result.err;
    const bool advised = result.err.find("ovimap models fetch") != std::string::npos;
    return read_map_info(path("room.ovimap")).encoder.name + (advised ? " advised" : "");
  };
  install("minilm", kDefaultEncoder, "");
  install("siglip", "doubtful", "preference: 90\nself_test: doubtful\n");
  EXPECT_EQ(encoder_of_run(), "golden minilm advised");
  install("clip", "better", "preference: 10\n");
  EXPECT_EQ(encoder_of_run(), "golden clip");
}

TEST_F(EmbeddingProgramTest, SaysPlainlyThatThereIsNoSuchDevice) {
  const std::string run_with = "run replica/scene -o room.ovimap --masks gt --encoder " +
                               golden_model("minilm") + " --device ";
  expect_complaint(run_with + "tensorrt", {"execution_provider is 'tensorrt'", "it has", "cpu"});
  expect_complaint(run_with + "gpu", {"execution_provider", "cuda"});
}

TEST_F(EmbeddingProgramTest, EmbedsFinishedGeometry) {
  map_with("none");
  ASSERT_EQ(run("export room.ovimap room.ply --what instances").code, 0);
  const auto report = run_json("embed room.ply replica/scene -o objects.ovimap --json --encoder " +
                               golden_model("minilm") + kSmallPictures);
  EXPECT_GT(report["instances"], 0);
  EXPECT_GT(report["embedding_queries"], 0);
  EXPECT_LE(run("query objects.ovimap mug --encoder " + golden_model("minilm")).code, 1);
  for (const char* out : {"a.ply", "a.png"})
    expect_complaint(std::string("export objects.ovimap ") + out, {"objects.ovimap", "surface"});
  std::ofstream(path("ids.txt")) << "4294967297\n";
  expect_complaint("embed room.ply replica/scene --ids ids.txt -o a.ovimap --encoder none",
                   {"ids.txt"});
  expect_complaint("embed missing.ply replica/scene -o a.ovimap --encoder none", {"missing.ply"});
  expect_complaint("embed gt recording -o a.ovimap --encoder none", {"recording"});
}

TEST_F(EmbeddingProgramTest, ExportsClasses) {
  map_with(golden_model("minilm"));
  const std::string encoder = " --what semantic --encoder " + golden_model("minilm");
  for (const char* file : {"a.ply", "a.png"})
    EXPECT_EQ(run(std::string("export room.ovimap ") + file + encoder).code, 0);
  ASSERT_EQ(run("export room.ovimap a.json --classes scannet20" + encoder).code, 0);
  const auto document = nlohmann::json::parse(slurp(path("a.json")));
  EXPECT_EQ(document["classes"], "scannet20");
  EXPECT_FALSE(document["instances"][0]["class"]["name"].get<std::string>().empty());
  expect_complaint("export room.ovimap a.json --classes birds" + encoder,
                   {"birds", "replica51", "scannet200"});
  expect_complaint("export room.ovimap b.ply --what semantic --encoder none", {"--encoder"});
}

TEST_F(EmbeddingProgramTest, ExportsClassesOfAnyFile) {
  map_with(golden_model("minilm"));
  const std::string command = "export room.ovimap a.json --what semantic --encoder " +
                              golden_model("minilm") + " --classes ";
  // A byte-order mark and Latin-1, and the name of a set that it is not.
  std::ofstream(path("scannet200.txt"), std::ios::binary) << "\xEF\xBB\xBFtable\nK\xFC"
                                                             "che\n";
  ASSERT_EQ(run(command + "./scannet200.txt").code, 0);
  const auto document = nlohmann::json::parse(slurp(path("a.json")));
  for (const auto& instance : document["instances"])
    EXPECT_LE(instance["class"]["id"].get<int>(), 2);
  EXPECT_EQ(run("eval room.ovimap --gt replica/scene --classes ./scannet200.txt --encoder " +
                golden_model("minilm"))
                .code,
            2);  // the truth's own ids are none of that file
}

TEST_F(EmbeddingProgramTest, OptionsMayComeFirst) {
  const std::string encoder = " --encoder " + golden_model("minilm");
  ASSERT_EQ(run("run --set map.voxel_size_m=0.02 --model-dir . replica/scene --masks gt -o "
                "room.ovimap" +
                encoder + kSmallPictures)
                .code,
            0);
  EXPECT_LE(run("query --model-dir . --not mug room.ovimap table" + encoder).code, 1);
}

TEST_F(EmbeddingProgramTest, SaysWhatIsWrong) {
  map_with(golden_model("minilm"));
  const std::string encoder = " --encoder " + golden_model("minilm");
  expect_complaint("query room.ovimap --image missing.jpg" + encoder, {"missing.jpg"});
  expect_complaint("run recording -o b.ovimap --encoder no-such-model", {"no-such-model"});
  expect_complaint("run recording -o b.ovimap --views best", {"best", "viewcov"});
  EXPECT_FALSE(std::filesystem::exists(path("b.ovimap")));
}

TEST_F(EmbeddingProgramTest, TheSameMapWhateverTheThreads) {
  std::set<std::string> views;
  for (const char* threads : {"1", "2"}) {
    ASSERT_EQ(run(std::string("run replica/scene --masks gt -o room.ovimap --threads ") + threads +
                  " --encoder " + golden_model("minilm") + kSmallPictures)
                  .code,
              0);
    views.insert(
        run("query room.ovimap mug chair --top 9 --json --encoder " + golden_model("minilm")).out);
  }
  EXPECT_EQ(views.size(), 1u);
}

}  // namespace
}  // namespace ovimap
