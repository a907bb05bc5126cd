// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// `ovimap query` as a user meets it.
#include "program_fixture.h"

namespace ovimap {
namespace {

class QueryProgramTest : public ProgramTest {
 protected:
  /// Maps the recording with embeddings; false where there is no encoder.
  bool map_with_embeddings() const {
    const ProgramResult models = run("models list --json");
    if (models.out.find("\"dual_encoder\"") == std::string::npos) return false;
    const ProgramResult result = run(
        "run replica/scene --masks gt --encoder default -o room.ovimap "
        "--set summary.min_instance_views=1 --set views.min_frames_seen=1 --set view_interval=1");
    EXPECT_EQ(result.code, 0) << result.err;
    return result.code == 0;
  }
};

TEST_F(QueryProgramTest, AnswersInTheDocumentedShape) {
  if (!map_with_embeddings()) GTEST_SKIP() << "no encoder; run tools/setup.sh";
  run("query room.ovimap table \"largest object\" --heatmap heat.ply");
  for (const char* file : {"heat-1-table.ply", "heat-2-largest-object.ply"})
    EXPECT_TRUE(std::filesystem::exists(path(file))) << file;
  const ProgramResult answer = run("query room.ovimap table \"largest object\" --top 2 --json");
  ASSERT_TRUE(answer.code == 0 || answer.code == 1) << answer.err;
  const auto report = nlohmann::json::parse(answer.out);
  ASSERT_EQ(report["results"].size(), 2u);
  for (const auto& query : report["results"]) {
    EXPECT_TRUE(query["verdict"] == "found" || query["verdict"] == "not_in_map");
    EXPECT_LE(query["instances"].size(), 2u);
    for (const auto& instance : query["instances"]) {
      EXPECT_GT(instance["id"], 0);
      EXPECT_GE(instance["probability"], 0.0);
      EXPECT_LE(instance["probability"], 1.0);
      EXPECT_LE(instance["box"]["min"][1], instance["box"]["max"][1]);
      EXPECT_EQ(instance["centroid"].size(), 3u);
    }
  }
  EXPECT_EQ(report["results"][0]["query"], "table");
  EXPECT_EQ(report["results"][1]["reading"], "largest [object]");
  EXPECT_EQ(report["results"][1]["verdict"], "found");
}

TEST_F(QueryProgramTest, FindsLookAlikesAndDrawsHeatMaps) {
  if (!map_with_embeddings()) GTEST_SKIP() << "no encoder; run tools/setup.sh";
  const auto objects = run_json("info room.ovimap --json")["instances"];
  ASSERT_FALSE(objects.empty());
  for (const char* file : {"heat.ply", "heat.png"}) {
    run(std::string("query room.ovimap table --heatmap ") + file);
    ASSERT_TRUE(std::filesystem::exists(path(file))) << file;
    EXPECT_GT(std::filesystem::file_size(path(file)), 100u);
  }
  expect_complaint("query room.ovimap table --heatmap heat.jpg", {"heat.jpg", ".ply"});
  expect_complaint("query room.ovimap --like 987654", {"987654"});
}

TEST_F(QueryProgramTest, SaysWhatIsWrong) {
  ASSERT_EQ(run("run recording -o bare.ovimap").code, 0);
  expect_complaint("query bare.ovimap mug", {"embedding", "reembed"});
  expect_complaint("query bare.ovimap", {"nothing is asked"});
  expect_complaint("query none.ovimap mug", {"none.ovimap"});
  expect_complaint("query bare.ovimap mug --set query.top=3", {"query.top", "query.top_k"});
  if (!map_with_embeddings()) GTEST_SKIP() << "no encoder; run tools/setup.sh";
  expect_complaint("query room.ovimap \"  \"", {"empty"});
  expect_complaint("query room.ovimap " + std::string(10000, 'a'), {"10000", "2000"});
  expect_complaint("query room.ovimap mug --encoder no-such-model", {"no-such-model"});
  expect_complaint("query room.ovimap mug --set query.prompts=plain", {"{}"});
}

}  // namespace
}  // namespace ovimap
