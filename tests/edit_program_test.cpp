// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// `ovimap edit` as a user meets it.
#include "program_fixture.h"

namespace ovimap {
namespace {

class EditProgramTest : public EncodedProgramTest {
 protected:
  std::vector<int> ids() const {
    std::vector<int> result;
    const auto info = run_json("info room.ovimap --json");
    for (const auto& entry : info["instances"]) result.push_back(entry["id"]);
    return result;
  }
  void edit(const std::string& arguments) const {
    const ProgramResult result = run("edit room.ovimap " + arguments);
    EXPECT_EQ(result.code, 0) << arguments << result.err;
  }
};

TEST_F(EditProgramTest, EverythingSeesTheCorrectedMap) {
  map_with(golden_model("minilm"));
  const std::vector<int> found = ids();
  ASSERT_GE(found.size(), 3u);
  const std::string first = std::to_string(found[0]), second = std::to_string(found[1]),
                    third = std::to_string(found[2]);
  edit("rename " + first + " 'tea pot'");
  edit("merge " + first + " " + second);
  EXPECT_EQ(ids().size(), found.size() - 1);
  const ProgramResult renamed = run("edit room.ovimap rename " + second + " 'tea pot'");
  EXPECT_NE(renamed.out.find("object " + second + " is part of object " + first),
            std::string::npos);
  edit("undo");
  ASSERT_EQ(run("export room.ovimap a.csv").code, 0);
  EXPECT_NE(slurp(path("a.csv")).find(first + ",tea pot,"), std::string::npos);
  ASSERT_EQ(run("report room.ovimap a.html --encoder none").code, 0);
  EXPECT_NE(slurp(path("a.html")).find("tea pot"), std::string::npos);
  const auto answer = nlohmann::json::parse(
      run("query room.ovimap thing --top 99 --json --encoder " + golden_model("minilm")).out);
  for (const auto& instance : answer["results"][0]["instances"])
    EXPECT_NE(instance["id"], found[1]);
  ASSERT_EQ(run("export room.ovimap whole.ply").code, 0);
  edit("hide " + third);
  ASSERT_EQ(run("export room.ovimap part.ply").code, 0);
  EXPECT_LT(std::filesystem::file_size(path("part.ply")),
            std::filesystem::file_size(path("whole.ply")));
  EXPECT_EQ(run_json("info room.ovimap --json")["hidden"], nlohmann::json({found[2]}));
  // Another encoder's embeddings, and the corrections are still there.
  ASSERT_EQ(run("reembed room.ovimap --encoder " + golden_model("clip")).code, 0);
  EXPECT_EQ(ids().size(), found.size() - 2);
  for (int i = 0; i < 3; ++i) edit("undo");
  EXPECT_EQ(ids(), found);
  expect_complaint("edit room.ovimap undo", {"nothing to undo"});
}

TEST_F(EditProgramTest, ANewMapDoesNotTakeTheCorrectedOnesPlace) {
  map_with("none");
  map_with("none");  // of one that nobody corrected nothing is lost
  const std::string first = std::to_string(ids().front());
  edit("rename " + first + " 'tea pot'");
  expect_complaint("run replica/scene --masks gt --encoder none -o room.ovimap",
                   {"has 1 correction that a new map in its place would lose", "--continue"});
  EXPECT_NE(run("info room.ovimap").out.find("tea pot"), std::string::npos);
  edit("undo");
  map_with("none");
}

TEST_F(EditProgramTest, SaysHowToMakeAMapWhole) {
  map_with("none");
  std::ofstream(path("room.ovimap-wal")) << "";  // what a change that was cut short leaves
  for (const char* command : {"info room.ovimap", "edit room.ovimap undo",
                              "export room.ovimap a.csv", "serve room.ovimap --port 0"})
    expect_complaint(command, {"cut short", "`ovimap info --recover room.ovimap`"});
  const ProgramResult done = run("info --recover room.ovimap");
  EXPECT_EQ(done.code, 0) << done.err;
  EXPECT_NE(done.out.find("all as written"), std::string::npos) << done.out;
  EXPECT_FALSE(std::filesystem::exists(path("room.ovimap-wal")));
  EXPECT_EQ(run("info room.ovimap").code, 0);
  EXPECT_NE(run("info --recover room.ovimap").err.find("nothing to recover"), std::string::npos);
}

TEST_F(EditProgramTest, TellsWhatWasDone) {
  map_with("none");
  const std::string id = std::to_string(ids()[0]);
  const auto done = run_json("edit room.ovimap lock " + id + " --json");
  EXPECT_EQ(done["edit"]["id"], 1);
  EXPECT_EQ(done["edit"]["action"], "lock");
  EXPECT_EQ(done["instances"], ids().size());
  expect_complaint("edit room.ovimap rename " + id + " x", {"locked", "undo 1"});
  edit("undo 1");
  const auto log = run_json("edit room.ovimap log --json")["edits"];
  ASSERT_EQ(log.size(), 2u);
  EXPECT_EQ(log[0]["undone_by"], 2);
  EXPECT_TRUE(log[1]["undone_by"].is_null());
  EXPECT_EQ(log[0]["time"].get<std::string>().size(), 20u);
  expect_complaint("edit room.ovimap rename 987654 x", {"987654", "info"});
  expect_complaint("edit room.ovimap rename lamp x", {"'lamp' is no number from 1 up"});
  expect_complaint("edit room.ovimap", {"edit"});
  expect_complaint("edit missing.ovimap log", {"missing.ovimap"});
}

/// What a person named answers to it, and teaches other maps when that is asked for.
TEST_F(EditProgramTest, NamesTeach) {
  map_with(golden_model("minilm"));
  const std::string id = std::to_string(ids()[1]);
  const auto best = [&](const std::string& options) {
    const std::string query = " zaphod --top 1 --json --encoder " + golden_model("minilm");
    return nlohmann::json::parse(
        run("query room.ovimap" + options + query).out)["results"][0]["instances"][0];
  };
  edit("rename " + id + " zaphod");
  EXPECT_EQ(best("")["id"], ids()[1]);
  EXPECT_LT(best(" --set query.evidence.taught_weight=0")["standard_score"].get<float>() + 5.f,
            best("")["standard_score"].get<float>());
  EXPECT_FALSE(std::filesystem::exists(path("taught.json"))) << "it is off unless it is asked for";
  const auto done =
      run_json("edit room.ovimap --teach taught.json --json rename " + id + " zaphod");
  EXPECT_EQ(done["taught"], 1);
  EXPECT_NE(slurp(path("taught.json")).find("zaphod"), std::string::npos);
  EXPECT_EQ(best(" --teach taught.json")["id"], ids()[1]);
  for (int i = 0; i < 2; ++i) run_json("edit room.ovimap --teach taught.json --json undo");
  EXPECT_EQ(slurp(path("taught.json")).find("zaphod"), std::string::npos);
}

TEST_F(EditProgramTest, SaysWhatIsWrongWithWhatWasTaught) {
  map_with("none");
  std::ofstream(path("taught.json")) << "{}";
  for (const char* command : {"query room.ovimap zaphod --teach taught.json --encoder none",
                              "serve room.ovimap --port 0 --teach taught.json",
                              "edit room.ovimap --teach taught.json rename 1 cup"})
    expect_complaint(command, {"taught.json", "--teach FILE"});
  EXPECT_TRUE(run_json("edit room.ovimap log --json")["edits"].empty()) << "rather none than half";
}

}  // namespace
}  // namespace ovimap
