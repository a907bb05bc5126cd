// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// `ovimap synth` as a user meets it, in rooms that need no furniture.
#include "ovimap/frames/frame/frame_source.h"
#include "program_fixture.h"

namespace ovimap {
namespace {

class SynthProgramTest : public ProgramTest {};

TEST_F(SynthProgramTest, AWalkIsAVideoWithItsTimes) {
  const auto report =
      run_json("synth out --room bare --walk --fps 10 --seconds 1.5 --size 64x48 --json");
  EXPECT_EQ(report["frames"], 15);
  const auto source = open_frame_source(path("out/bare"));
  ASSERT_EQ(source->size(), 15);
  const Frame first = *source->read(3).frame, second = *source->read(4).frame;
  EXPECT_NEAR(second.timestamp_s - first.timestamp_s, 0.1, 1e-6);
  EXPECT_EQ(first.color.width(), 64);
  const double moved_m =
      (second.world_from_camera.translation() - first.world_from_camera.translation()).norm();
  EXPECT_GT(moved_m, 0.02);
  EXPECT_LT(moved_m, 0.12);
  const std::string settings = slurp(path("out/bare/settings.yaml"));
  EXPECT_NE(settings.find("video.walk.speed_mps: 0.7"), std::string::npos) << settings;
  EXPECT_NE(settings.find("noise: true"), std::string::npos);
}

TEST_F(SynthProgramTest, SinglePicturesHaveNeitherTimesNorSettingsOfAWalk) {
  ASSERT_EQ(run("synth out --room bare --frames 2").code, 0);
  EXPECT_FALSE(std::filesystem::exists(path("out/room/timestamps.txt")));
  EXPECT_EQ(slurp(path("out/room/settings.yaml")).find("video"), std::string::npos);
}

TEST_F(SynthProgramTest, VisitsAreRecordingsInOneFrameWithTheTruthBetweenThem) {
  const auto report = run_json("synth out --room bare --visits 2 --frames 2 --size 64x48 --json");
  ASSERT_EQ(report["scenes"].size(), 2u);
  for (const char* visit : {"out/visit1", "out/visit2"}) {
    EXPECT_EQ(open_frame_source(path(visit))->size(), 2) << visit;
    EXPECT_TRUE(std::filesystem::exists(path(std::string(visit) + "_mesh.ply"))) << visit;
  }
  const auto truth = nlohmann::json::parse(slurp(path("out/changes.json")));
  EXPECT_EQ(truth["visits"], nlohmann::json({"visit1", "visit2"}));
  EXPECT_TRUE(truth["changes"].empty()) << "nothing stands in a bare room";
  for (const char* set : {"rooms-v1", "apartments-v1"})
    expect_complaint(concat("synth more --visits 2 --room ", set), {"--visits", "one room", set});
}

TEST_F(SynthProgramTest, SaysWhatIsWrong) {
  expect_complaint("synth out --room bare --fps 10", {"--fps", "--walk"});
  expect_complaint("synth out --room bare --walk --size 64", {"--size", "640x480"});
  expect_complaint("synth out --plan lop", {"lop", "loop"});
  expect_complaint("synth out --plan loop --room tiny", {"--room"});
}

}  // namespace
}  // namespace ovimap
