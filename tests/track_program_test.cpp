// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "program_fixture.h"

namespace ovimap {
namespace {

/// A recording without poses ("unposed"), and the true ones beside it ("truth.txt").
class TrackProgramTest : public ProgramTest {
 protected:
  TrackProgramTest() {
    sequence_.depth_camera = sequence_.color_camera = {320, 240, 280.f, 280.f, 159.5f, 119.5f};
    sequence_.frames = 20;
    std::filesystem::create_directories(path("unposed"));
    fixture::write_folder(path("unposed"), sequence_);
    std::string truth;
    for (int i = 0; i < sequence_.frames; ++i)
      truth += concat(i / 30., " ", fixture::tum_text(sequence_.pose(i)), "\n");
    write_text(path("truth.txt"), truth);
  }
  /// Makes a frame one of darkness: nothing near enough to be depth.
  void cover(int frame) const {
    const Image<std::uint16_t> dark(320, 240, 20);  // 2 cm
    write_file(path("unposed") / "depth" / concat(frame, ".png"), encode_png(dark));
  }
  static constexpr const char* kRun =
      "run unposed --set map.voxel_size_m=0.02 --trajectory poses.txt -o map.ovimap ";
};

TEST_F(TrackProgramTest, MapsARecordingWithoutPoses) {
  const ProgramResult result = run(kRun);
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_NE(result.out.find("tracked 20 of 20 frames, lost 0 times"), std::string::npos)
      << result.out;
  const auto scores = run_json("eval-poses poses.txt truth.txt --json");
  EXPECT_EQ(scores["matched"], 20);
  EXPECT_LT(scores["ate_m"]["rmse"], 0.015);
}

TEST_F(TrackProgramTest, IsTheSameForAnyNumberOfThreads) {
  EXPECT_EQ(run(std::string(kRun) + "--threads 1").code, 0);
  const std::string one = slurp(path("poses.txt"));
  EXPECT_EQ(run(std::string(kRun) + "--threads 3").code, 0);
  EXPECT_EQ(one, slurp(path("poses.txt")));
}

TEST_F(TrackProgramTest, LiveTracksAsWell) {
  const auto report = run_json(std::string(kRun) + "--live --fps 5 --json");
  EXPECT_EQ(report["tracking"]["frames_tracked"], report["frames"]);
  EXPECT_EQ(report["live"]["frames_lost"], 0);
}

TEST_F(TrackProgramTest, GivenPosesArePredictionsToRefine) {
  const auto report =
      run_json("run recording --poses refine --set map.voxel_size_m=0.03 -o map.ovimap --json");
  EXPECT_EQ(report["tracking"]["frames_tracked"], report["frames"]);
}

TEST_F(TrackProgramTest, ACoveredLensIsToldAndMapsNothing) {
  for (int frame : {9, 10, 11}) cover(frame);
  const auto report = run_json(std::string(kRun) + "--json");
  EXPECT_EQ(report["frames"], 17);
  EXPECT_EQ(report["tracking"]["frames_tracked"], 17);
}

TEST_F(TrackProgramTest, WhatNeedsPosesSaysSo) {
  expect_complaint("check unposed", {"no poses", "ovimap run"});
  expect_complaint("run unposed --poses given -o map.ovimap", {"no poses"});
  expect_complaint("eval-poses truth.txt poses.txt", {"poses.txt"});
}

}  // namespace
}  // namespace ovimap
