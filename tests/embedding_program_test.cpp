// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// Embeddings as a user meets them. The golden encoders have random weights: what they find means
// nothing, but everything else about them is real.
#include "program_fixture.h"

namespace ovimap {
namespace {

std::string golden(const std::string& name) {
  return "'" OVIMAP_SOURCE_DIR "/src/ovimap/inference/testdata/golden_" + name + "'";
}

class EmbeddingProgramTest : public ProgramTest {
 protected:
  static constexpr const char* kSmallViews =
      " --set views.min_mask_px=20 --set views.min_first_depth_px=10 --set views.min_depth_px=10 "
      "--set summary.min_instance_views=1 --set views.min_frames_seen=1";

  void map_with(const std::string& encoder) const {
    const ProgramResult result =
        run("run replica/scene --masks gt -o room.ovimap --encoder " + encoder + kSmallViews);
    ASSERT_EQ(result.code, 0) << result.err;
  }
};

TEST_F(EmbeddingProgramTest, MakesOldMapsSearchable) {
  map_with("none");
  expect_complaint("query room.ovimap mug --encoder " + golden("minilm"), {"reembed"});
  const auto report = run_json("reembed room.ovimap --json --encoder " + golden("minilm"));
  EXPECT_GT(report["instances"], 0);
  EXPECT_EQ(report["dimension"], 16);
  EXPECT_LE(run("query room.ovimap mug --encoder " + golden("minilm")).code, 1);
  // Another model's space: say so and offer the remedy.
  expect_complaint("query room.ovimap mug --encoder " + golden("clip"), {"reembed"});
}

TEST_F(EmbeddingProgramTest, EmbedsFinishedGeometry) {
  map_with("none");
  ASSERT_EQ(run("export room.ovimap room.ply --what instances").code, 0);
  const auto report = run_json("embed room.ply replica/scene -o objects.ovimap --json --encoder " +
                               golden("minilm") + kSmallViews);
  EXPECT_GT(report["instances"], 0);
  EXPECT_GT(report["embedding_queries"], 0);
  EXPECT_LE(run("query objects.ovimap mug --encoder " + golden("minilm")).code, 1);
  expect_complaint("embed missing.ply replica/scene -o a.ovimap --encoder none", {"missing.ply"});
  expect_complaint("embed gt recording -o a.ovimap --encoder none", {"recording"});
}

TEST_F(EmbeddingProgramTest, ExportsClasses) {
  map_with(golden("minilm"));
  const std::string encoder = " --what semantic --encoder " + golden("minilm");
  for (const char* file : {"a.ply", "a.png"})
    EXPECT_EQ(run(std::string("export room.ovimap ") + file + encoder).code, 0);
  ASSERT_EQ(run("export room.ovimap a.json --classes scannet20" + encoder).code, 0);
  const auto document = nlohmann::json::parse(slurp(path("a.json")));
  EXPECT_EQ(document["classes"], "scannet20");
  EXPECT_FALSE(document["instances"][0]["class"]["name"].get<std::string>().empty());
  expect_complaint("export room.ovimap a.json --classes birds" + encoder,
                   {"birds", "replica51", "scannet200"});
}

TEST_F(EmbeddingProgramTest, SaysWhatIsWrong) {
  map_with(golden("minilm"));
  const std::string encoder = " --encoder " + golden("minilm");
  expect_complaint("query room.ovimap --image missing.jpg" + encoder, {"missing.jpg"});
  expect_complaint("run recording -o b.ovimap --encoder no-such-model", {"no-such-model"});
  expect_complaint("run recording -o b.ovimap --views best", {"best", "viewcov"});
  EXPECT_FALSE(std::filesystem::exists(path("b.ovimap")));
}

TEST_F(EmbeddingProgramTest, TheSameMapWhateverTheThreads) {
  std::set<std::string> views;
  for (const char* threads : {"1", "2"}) {
    ASSERT_EQ(run(std::string("run replica/scene --masks gt -o room.ovimap --threads ") + threads +
                  " --encoder " + golden("minilm") + kSmallViews)
                  .code,
              0);
    views.insert(
        run("query room.ovimap mug chair --top 9 --json --encoder " + golden("minilm")).out);
  }
  EXPECT_EQ(views.size(), 1u);
}

}  // namespace
}  // namespace ovimap
