// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// `ovimap query` as a user meets it.
#include "program_fixture.h"

#include <sys/stat.h>

#include <cstdlib>

namespace ovimap {
namespace {

class QueryProgramTest : public EncodedProgramTest {
 protected:
  /// A query of room.ovimap; exit code 0 or 1, as the verdict has it.
  nlohmann::json query(const std::string& arguments) const {
    const ProgramResult answer = run("query room.ovimap --json " + arguments + kEncoder);
    EXPECT_LE(answer.code, 1) << arguments << answer.err;
    const auto report = nlohmann::json::parse(answer.out, nullptr, false);
    bool found = false;
    for (const auto& result : report["results"]) found = found || result["verdict"] == "found";
    EXPECT_EQ(answer.code, found ? 0 : 1);
    return report["results"];
  }

  const std::string kEncoder = " --encoder " + golden_model("minilm");
};

TEST_F(QueryProgramTest, AnswersInTheDocumentedShape) {
  map_with(golden_model("minilm"));
  const auto results = query("table \"largest object\" --top 2 --heatmap heat.ply");
  for (const char* file : {"heat-1-table.ply", "heat-2-largest-object.ply"})
    EXPECT_TRUE(std::filesystem::exists(path(file))) << file;
  ASSERT_EQ(results.size(), 2u);
  for (const auto& result : results) {
    EXPECT_TRUE(result["verdict"] == "found" || result["verdict"] == "not_in_map");
    EXPECT_LE(result["instances"].size(), 2u);
    for (const auto& instance : result["instances"]) {
      EXPECT_GT(instance["id"], 0);
      EXPECT_GE(instance["probability"], 0.0);
      EXPECT_LE(instance["probability"], 1.0);
      EXPECT_LE(instance["box"]["min"][1], instance["box"]["max"][1]);
      EXPECT_EQ(instance["centroid"].size(), 3u);
    }
  }
  EXPECT_EQ(results[0]["query"], "table");
  EXPECT_EQ(results[1]["reading"], "largest [object]");
  EXPECT_EQ(results[1]["verdict"], "found");
}

TEST_F(QueryProgramTest, EncodesTheWordsOfVerdictsOnceForAllProcesses) {
  map_with(golden_model("minilm"));
  const std::string ask = "query room.ovimap table --json" + kEncoder;
  const auto with_cache = [&](const char* folder) {
    ::setenv("XDG_CACHE_HOME", path(folder).c_str(), 1);
    const ProgramResult answer = run(ask);
    ::unsetenv("XDG_CACHE_HOME");
    EXPECT_LE(answer.code, 1) << answer.err;
    return answer.out;
  };
  const auto stored = [&] {
    std::vector<std::pair<std::filesystem::path, std::uint64_t>> files;
    for (const auto& entry : std::filesystem::directory_iterator(path("cache/ovimap"))) {
      struct stat about = {};
      EXPECT_EQ(::stat(entry.path().c_str(), &about), 0);
      files.emplace_back(entry.path(), about.st_ino);
    }
    return files;
  };
  const std::string first = with_cache("cache");
  const auto files = stored();
  ASSERT_EQ(files.size(), 2u);  // the words that calibrate, and those that compete
  EXPECT_EQ(with_cache("cache"), first);
  EXPECT_EQ(stored(), files) << "encoding them again would have replaced the file";
  write_text(path("file"), "where a folder of caches should be");
  EXPECT_EQ(with_cache("file"), first);
}

TEST_F(QueryProgramTest, FindsLookAlikes) {
  map_with(golden_model("minilm"));
  const auto objects = run_json("info room.ovimap --json")["instances"];
  ASSERT_GE(objects.size(), 2u);
  const int id = objects[0]["id"];
  const auto alike = query("--like " + std::to_string(id))[0];
  ASSERT_GE(alike["instances"].size(), 1u);
  for (const auto& instance : alike["instances"]) EXPECT_NE(instance["id"], id);
  const std::string picture = "replica/scene/results/frame000000.jpg";
  const auto seen = query("--image " + picture)[0];
  EXPECT_EQ(seen["query"], picture);
  EXPECT_GE(seen["instances"].size(), 1u);
  EXPECT_NE(seen["reason"].get<std::string>().find("too few"), std::string::npos);
  expect_complaint("query room.ovimap --like 987654", {"987654"});
  expect_complaint("query room.ovimap --not mug --image " + picture, {"--not", "TEXT"});
}

TEST_F(QueryProgramTest, NarrowsWhatIsAsked) {
  map_with(golden_model("minilm"));
  EXPECT_EQ(query("anything --near table")[0]["reading"], "[anything] near [table]");
  expect_complaint("query room.ovimap \"mug on the table\" --near door" + kEncoder, {"--near"});
  const auto all = query("thing --top 99")[0]["instances"];
  const auto without = query("thing --top 99 --not thing")[0]["instances"];
  EXPECT_LE(without.size(), all.size());
  EXPECT_EQ(query("table --set query.top_k=1")[0]["instances"].size(), 1u);
}

TEST_F(QueryProgramTest, DrawsHeatMaps) {
  map_with(golden_model("minilm"));
  for (const char* file : {"heat.ply", "heat.png"}) {
    query(std::string("table --heatmap ") + file);
    ASSERT_TRUE(std::filesystem::exists(path(file))) << file;
    EXPECT_GT(std::filesystem::file_size(path(file)), 100u);
  }
  expect_complaint("query room.ovimap table --heatmap heat.jpg", {"heat.jpg", ".ply"});
  expect_complaint("query room.ovimap table --heatmap none/heat.png" + kEncoder,
                   {"none/heat.png", "create the folder"});
}

TEST_F(QueryProgramTest, SaysWhereToStandForWhatItFound) {
  map_with(golden_model("minilm"));
  const auto found = query("\"largest object\" --approach --from 0,0 --radius 0.1")[0];
  ASSERT_EQ(found["verdict"], "found");
  for (const auto& instance : found["instances"]) {
    const auto& approach = instance["approach"];
    EXPECT_EQ(approach["poses"].empty(), !approach["reason"].get<std::string>().empty());
    for (const auto& pose : approach["poses"]) EXPECT_GE(pose["seen"], 0.3);
  }
  EXPECT_FALSE(query("\"largest object\"")[0]["instances"][0].contains("approach"));
  expect_complaint("query room.ovimap anything --from 0,0" + kEncoder, {"--from", "--approach"});
  expect_complaint("query room.ovimap anything --approach --set approach.radius_m=-1" + kEncoder,
                   {"approach.radius_m", "-1"});
  const ProgramResult rooms = run("info room.ovimap --rooms");
  EXPECT_EQ(rooms.code, 0) << rooms.err;
  EXPECT_NE(rooms.out.find("room"), std::string::npos);
}

TEST_F(QueryProgramTest, SaysWhatIsWrong) {
  ASSERT_EQ(run("run recording -o bare.ovimap").code, 0);
  expect_complaint("query bare.ovimap mug", {"embedding", "reembed"});
  expect_complaint("query bare.ovimap", {"nothing is asked"});
  const auto known = nlohmann::json::parse(run("info bare.ovimap --json").out);
  const int id = known["instances"][0]["id"];
  ASSERT_EQ(run(concat("edit bare.ovimap rename ", id, " \"Anna's mug\"")).code, 0);
  const ProgramResult named = run("query bare.ovimap mug --json");
  EXPECT_EQ(named.code, 0) << named.err;
  EXPECT_EQ(nlohmann::json::parse(named.out)["results"][0]["instances"][0]["id"], id);
  expect_complaint("query bare.ovimap sofa", {"embedding", "reembed"});
  expect_complaint("query none.ovimap mug", {"none.ovimap"});
  expect_complaint("query bare.ovimap mug --set query.top=3", {"query.top", "query.top_k"});
  map_with(golden_model("minilm"));
  expect_complaint("query room.ovimap mug", {"golden", "--encoder"});  // not on the search path
  expect_complaint("query room.ovimap \"  \"", {"empty"});
  expect_complaint("query room.ovimap " + std::string(10000, 'a'), {"10000", "2000"});
  expect_complaint("query room.ovimap mug --encoder no-such-model", {"no-such-model"});
  expect_complaint("query room.ovimap mug --set query.prompts=plain" + kEncoder, {"{}"});
}

}  // namespace
}  // namespace ovimap
