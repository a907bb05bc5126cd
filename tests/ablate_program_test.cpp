// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// `ovimap ablate` as a user meets it.
#include "truth_fixture.h"

namespace ovimap {
namespace {

class AblateProgramTest : public TruthfulProgramTest {
 protected:
  AblateProgramTest() { make_map("none"); }

  std::string command(const std::string& name) const {
    return "ablate " + name + " replica/scene -o out --masks gt --encoder " +
           golden_model("minilm") + " --model-dir " + kGoldenModels + kSmallPictures;
  }
  std::size_t lines_with(const std::string& file, const std::string& word) const {
    std::istringstream text(slurp(path(file)));
    std::size_t count = 0;
    for (std::string line; std::getline(text, line);) count += line.find(word) != std::string::npos;
    return count;
  }
};

TEST_F(AblateProgramTest, ComparesFusionRules) {
  const ProgramResult result = run(command("fusion"));
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(result.out, slurp(path("out/fusion.md")));
  EXPECT_EQ(lines_with("out/fusion.md", "| pixel_weighted |"), 3u) << "two protocols, one paper";
  EXPECT_EQ(lines_with("out/fusion.csv", ",measured,"), 8u);
  EXPECT_EQ(lines_with("out/fusion.csv", "\"published, Replica\",26.9,33.2,36.4,22,8.6"), 1u);
  EXPECT_EQ(lines_with("out/fusion.svg", "<rect"), 1 + 5 + 4 * 5u);
  EXPECT_EQ(slurp(path("out/fusion.svg")).find("nan"), std::string::npos);
}

TEST_F(AblateProgramTest, PrintsPublishedRowsApart) {
  ASSERT_EQ(run(command("views")).code, 0);
  EXPECT_EQ(lines_with("out/views.md", "*published, Replica*"), 5u);
  EXPECT_EQ(lines_with("out/views.md", "*published, ScanNet*"), 5u);
  EXPECT_EQ(lines_with("out/views.md", "| true objects, coverage | standard |"), 1u);
  EXPECT_EQ(lines_with("out/views.csv", "\"published, Replica\",26.5,32.2,34.5,21.2,8.6"), 1u);
}

TEST_F(AblateProgramTest, MasksAreComparedInWordsToo) {
  if (run("models verify mobilesam").code != 0) GTEST_SKIP() << "MobileSAM is not installed";
  const ProgramResult result = run(command("masks"));
  ASSERT_EQ(result.code, 0) << result.err;
  // The true objects are the truth, and every row has figures of classes, also that without masks.
  EXPECT_EQ(lines_with("out/masks.md", "| true objects | standard | 100.0 | 100.0 | 100.0 | 100.0"),
            1u);
  EXPECT_EQ(lines_with("out/masks.md", "| none: depth alone | standard |"), 1u);
  EXPECT_EQ(lines_with("out/masks.csv", ",,"), 3u) << "only published rows lack a figure, AP25";
  EXPECT_EQ(lines_with("out/masks.md", "| OVO-SLAM | *published, Replica* | *42.7*"), 1u);
  EXPECT_EQ(lines_with("out/masks.md", "| Mask3D + OpenMask3D, offline | *published"), 1u);
}

TEST_F(AblateProgramTest, GoesOnWhereItStopped) {
  ASSERT_EQ(run(command("incremental")).code, 0);
  const auto map = path("out/maps/incremental/scene-coverage-25.ovimap");
  ASSERT_TRUE(std::filesystem::exists(map));
  const auto written = std::filesystem::last_write_time(map);
  ASSERT_EQ(run(command("incremental")).code, 0);
  EXPECT_EQ(std::filesystem::last_write_time(map), written);
  EXPECT_EQ(lines_with("out/incremental.svg", "<polyline"), 7 * 2u);  // columns, curves
  EXPECT_EQ(lines_with("out/incremental.md", "| pixels, 200 | standard |"), 1u);
  expect_complaint(command("incremental") + " --frames ::2", {"settings.txt", "another folder"});
}

TEST_F(AblateProgramTest, TimesTheStages) {
  ASSERT_EQ(run(command("timing")).code, 0);
  EXPECT_EQ(lines_with("out/timing.md", "| view features | encoder's |"), 1u);
  EXPECT_EQ(lines_with("out/timing.md", "*964.8*"), 1u);
}

TEST_F(AblateProgramTest, SchedulesAreInSecondsOfTheVideo) {
  ASSERT_EQ(run(command("schedule")).code, 0);
  EXPECT_EQ(lines_with("out/schedule.md", "Frames a second that are mapped: 30.0."), 1u);
  EXPECT_EQ(lines_with("out/schedule.md", "| paper: masks 1, views 3 a second |"), 2u);
  // A map remembers how it was made: 30 frames a second have masks in every 30th.
  const auto config_of = [&](const std::string& map) {
    return run_json("info out/maps/schedule/scene-" + map + ".ovimap --json")["config"]
        .get<std::string>();
  };
  EXPECT_NE(config_of("offline-every-frame").find("\nmask_interval: 1\n"), std::string::npos);
  const std::string paper = config_of("paper-masks-1-views-3-a-second");
  EXPECT_NE(paper.find("\nmask_interval: 30\n"), std::string::npos);
  EXPECT_NE(paper.find("\nview_interval: 10\n"), std::string::npos);
}

TEST_F(AblateProgramTest, ASchedulesInputIsAVideo) {
  const auto times = [&](double spacing_s) {
    std::string text;
    for (int i = 0; i < 100; ++i) text += concat(spacing_s * i, "\n");
    write_text(path("replica/scene/timestamps.txt"), text);
  };
  times(0.001);  // as if frames from all sides had been taken in no time
  expect_complaint(command("schedule"), {"replica/scene", "m and turns", "--walk"});
  times(1);
  expect_complaint(command("schedule"), {"replica/scene", "1 frames a second", "--walk"});
  EXPECT_FALSE(std::filesystem::exists(path("out/maps"))) << "said before anything slow";
}

TEST_F(AblateProgramTest, SaysWhatIsWrong) {
  expect_complaint(command("viewz"), {"viewz", "views"});
  expect_complaint("ablate fusion replica/scene -o late --encoder none --masks nosuch", {"nosuch"});
  EXPECT_FALSE(std::filesystem::exists(path("late/maps"))) << "said before anything slow";
  expect_complaint("ablate fusion recording -o out --masks none --encoder none", {"recording"});
}

}  // namespace
}  // namespace ovimap
