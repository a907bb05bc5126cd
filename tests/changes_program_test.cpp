// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// `ovimap eval-changes` on two visits to a rendered room.
#include "program_fixture.h"

namespace ovimap {
namespace {

using nlohmann::json;

class ChangesProgramTest : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    const std::string as = " --masks gt --encoder none --set map.voxel_size_m=0.02 ";
    ASSERT_EQ(run("synth room --room tiny --seed 5 --visits 2 --frames 30 --size 160x120").code, 0);
    ASSERT_EQ(run("run room/visit1" + as + "-o home.ovimap").code, 0);
    ASSERT_EQ(run("run room/visit2" + as + "--continue home.ovimap").code, 0);
  }
  json scores() const { return run_json("eval-changes home.ovimap room --json"); }
};

TEST_F(ChangesProgramTest, WhatMovedOutOfSightIsKnownToHaveLeft) {
  const json found = scores();
  for (const char* kind : {"moved", "removed", "added"})
    EXPECT_EQ(found[kind]["right"], found[kind]["told"]) << found;
  EXPECT_EQ(found["moved"]["right"], 3) << found;
  EXPECT_EQ(found["removed"]["right"], 1) << found;
  EXPECT_EQ(found["added"]["right"], 1) << found;
  EXPECT_EQ(found["ids_kept"], 3) << found;

  const json elsewhere = {{"min", {90, 90, 0}}, {"max", {91, 91, 1}}};
  json truth = json::parse(slurp(path("room/changes.json")));
  for (json& change : truth["changes"]) {
    if (change["kind"] == "moved") continue;
    change[change["kind"] == "removed" ? "to" : "from"] = elsewhere;
    change["kind"] = "moved";
  }
  write_text(path("room/changes.json"), truth.dump());
  EXPECT_EQ(scores(), found) << "nobody could see where they are";
}

/// The second visit sees next to nothing, so what changed before it is news in the third.
TEST_F(ChangesProgramTest, WhatNobodySawInTimeIsTrueLater) {
  const std::string as = " --masks gt --encoder none --set map.voxel_size_m=0.02 ";
  ASSERT_EQ(run("synth late --room tiny --seed 5 --visits 3 --frames 30 --size 160x120").code, 0);
  const std::filesystem::path hasty = path("late/visit2");
  const std::string poses = slurp(hasty / "traj.txt");
  std::size_t end = 0;
  for (int frame = 0; frame < 3; ++frame) end = poses.find('\n', end) + 1;
  write_text(hasty / "traj.txt", poses.substr(0, end));
  for (const auto& file : std::filesystem::directory_iterator(hasty / "results"))
    if (const std::string name = file.path().stem().string();
        name.substr(name.size() - 6) > "000002")
      std::filesystem::remove(file);
  ASSERT_EQ(run("run late/visit1" + as + "-o late.ovimap").code, 0);
  for (const char* visit : {"visit2", "visit3"})
    ASSERT_EQ(run(concat("run late/", visit, as, "--continue late.ovimap")).code, 0);
  const json removed = run_json("eval-changes late.ovimap late --json")["removed"];
  EXPECT_EQ(removed["right"], removed["told"]) << removed;
  EXPECT_GE(removed["right"], 2) << removed;
}

}  // namespace
}  // namespace ovimap
