// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// `ovimap diff`, `ovimap merge` and `ovimap info --check` as a user meets them.
#include "program_fixture.h"

namespace ovimap {
namespace {

using CompareProgramTest = EncodedProgramTest;

TEST_F(CompareProgramTest, AMapHasNotChangedFromItself) {
  map_with(golden_model("minilm"));
  const auto report = run_json("diff room.ovimap room.ovimap -o changes.png --json");
  EXPECT_GT(report["alignment"]["fit"], 0.95);
  EXPECT_EQ(report["changes"].size(), run_json("info room.ovimap --json")["instances"].size());
  for (const auto& change : report["changes"]) {
    EXPECT_EQ(change["change"], "same");
    EXPECT_EQ(change["before"], change["after"]);
    EXPECT_FALSE(change["evidence"].get<std::string>().empty());
  }
  EXPECT_EQ(slurp(path("changes.png")).substr(1, 3), "PNG");
  expect_complaint("diff room.ovimap room.ovimap -o changes.txt", {".png", ".ply"});
  expect_complaint("diff room.ovimap room.ovimap -o nowhere/a.png", {"nowhere"});
  expect_complaint("diff room.ovimap gone.ovimap", {"gone.ovimap"});
}

TEST_F(CompareProgramTest, TwoMapsBecomeOne) {
  map_with(golden_model("minilm"));
  const auto before = run_json("info room.ovimap --json");
  const auto merged = run_json("merge room.ovimap room.ovimap -o both.ovimap --json");
  EXPECT_EQ(merged["instances"], before["instances"].size());
  EXPECT_EQ(merged["pairs"].size(), before["instances"].size());
  const auto after = run_json("info both.ovimap --json");
  EXPECT_EQ(after["blocks"], before["blocks"]);
  EXPECT_EQ(after["frames"], 2 * before["frames"].get<int>());
  EXPECT_EQ(run_json("edit both.ovimap log --json")["edits"].size(), merged["pairs"].size());
  EXPECT_LE(run("query both.ovimap thing --encoder " + golden_model("minilm")).code, 1);
  const ProgramResult again = run("merge room.ovimap room.ovimap -o twice.ovimap");
  EXPECT_EQ(again.code, 0) << again.err;
}

TEST_F(CompareProgramTest, ATransformIsRefusedWhenItIsNone) {
  map_with("none", " --set map.voxel_size_m=0.01");
  const std::string command = "merge room.ovimap room.ovimap -o both.ovimap --transform t.txt";
  expect_complaint(command, {"t.txt"});
  write_text(path("t.txt"), "1 0 0 0 1 0 0 0 1");
  expect_complaint(command, {"16 numbers"});
  write_text(path("t.txt"), "2 0 0 0  0 2 0 0  0 0 2 0  0 0 0 1");
  expect_complaint(command, {"orthonormal"});
  expect_complaint(command + " --align", {"--align"});
  write_text(path("t.txt"), "1 0 0 0  0 1 0 0.3  0 0 1 0  0 0 0 1");
  expect_complaint(command, {"contradict", "--align"});
  EXPECT_FALSE(std::filesystem::exists(path("both.ovimap")));
}

TEST_F(CompareProgramTest, DamageIsListed) {
  map_with("none");
  EXPECT_EQ(run_json("info room.ovimap --check --json")["ok"], true);
  std::string bytes = slurp(path("room.ovimap"));
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 0x10);
  write_text(path("room.ovimap"), bytes);
  const ProgramResult check = run("info room.ovimap --check");
  EXPECT_EQ(check.code, 1) << check.out << check.err;
  EXPECT_NE(check.out.find("damaged: "), std::string::npos);
  EXPECT_EQ(slurp(path("room.ovimap")), bytes);
}

}  // namespace
}  // namespace ovimap
