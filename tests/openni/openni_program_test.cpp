// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// The program with the real library, whose only driver is that of the software camera.
#include "../program_fixture.h"
#include "camera_film_fixture.h"

namespace ovimap {
namespace {

class OpenNiProgramTest : public ProgramTest {
 protected:
  OpenNiProgramTest() {
    ::setenv("LD_LIBRARY_PATH", OVIMAP_OPENNI_FOLDER, 1);
    ::unsetenv("OVIMAP_CAMERA_FILM");
    sequence_.depth_camera = sequence_.color_camera = {320, 240, 280.f, 280.f, 159.5f, 119.5f};
    sequence_.frames = 20;
  }
  ~OpenNiProgramTest() override { ::unsetenv("LD_LIBRARY_PATH"); }

  void plug_in(int fps = 5) const {
    fixture::plug_in(path("film"), fixture::film_of(sequence_, fps));
  }
  /// Runs the program until `file` is there, and presses Ctrl-C.
  ProgramResult interrupted(const std::string& arguments, const std::string& file) const {
    write_text(path("interrupt.sh"),
               concat("set -m\n'" OVIMAP_PROGRAM "' ", arguments, " &\n",
                      "for i in $(seq 600); do test -e ", file, " && break; sleep 0.1; done\n",
                      "sleep 4\nkill -INT $!\nwait $!\n"));
    const int status = std::system(
        concat("cd '", folder_.path().string(), "' && bash interrupt.sh > out.txt 2> err.txt")
            .c_str());
    return {WEXITSTATUS(status), slurp(path("out.txt")), slurp(path("err.txt"))};
  }
  void write_truth() const {
    std::string truth;
    for (int i = 0; i < sequence_.frames; ++i)
      truth += concat(std::to_string(1 + i / 30.), " ", fixture::tum_text(sequence_.pose(i)), "\n");
    write_text(path("truth.txt"), truth);
  }
  static constexpr const char* kRun =
      "run openni: --set map.voxel_size_m=0.02 --trajectory poses.txt -o map.ovimap ";
};

TEST_F(OpenNiProgramTest, MapsWhatACameraShowsUntilItIsUnplugged) {
  write_truth();
  for (const double units : {1000., 10000.}) {
    sequence_.depth_units_per_m = units;
    plug_in();
    const ProgramResult result = run(std::string(kRun) + "--json");
    EXPECT_EQ(result.code, 1) << result.err;
    EXPECT_EQ(
        result.err,
        "ovimap: ovimap software camera was unplugged; what it showed until then is in the map\n");
    const auto report = nlohmann::json::parse(result.out);
    EXPECT_GE(report["frames"], 12) << "of 20; some pass while the program starts";
    EXPECT_EQ(report["tracking"]["frames_tracked"], report["frames"]);
    const auto scores = run_json("eval-poses poses.txt truth.txt --json");
    EXPECT_EQ(scores["matched"], report["frames"]);
    EXPECT_LT(scores["ate_m"]["rmse"], 0.015)
        << "left and right swapped, or another field of view?";
    EXPECT_EQ(run_json("info map.ovimap --json")["frames"], report["frames"]);
  }
}

TEST_F(OpenNiProgramTest, AnotherVisitGoesOnWithAMap) {
  const std::string with_frames = std::string(kRun) + "--set frame_store.max_mb=100 ";
  plug_in();
  EXPECT_EQ(run(with_frames).code, 1) << "unplugged";
  expect_complaint("run openni: --set map.voxel_size_m=0.03 --continue map.ovimap",
                   {"map.voxel_size_m"});
  const auto report = nlohmann::json::parse(run(with_frames + "--json --continue map.ovimap").out);
  EXPECT_GE(report["tracking"]["frames_tracked"], 12) << "it finds its place in the map";
  const auto history = run_json("info map.ovimap --json")["history"];
  EXPECT_EQ(history["visits"].size(), 2u);
  EXPECT_TRUE(history["events"].empty()) << history["events"].dump();
}

TEST_F(OpenNiProgramTest, CtrlCSavesTheMap) {
  sequence_.frames = 40;
  plug_in(1);  // a frame a second: long enough for any machine
  const ProgramResult result = interrupted(kRun, "map.ovimap.partial");
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(result.err.find("unplugged"), std::string::npos) << result.err;
  EXPECT_GT(run_json("info map.ovimap --json")["frames"], 0);
}

TEST_F(OpenNiProgramTest, WhatIsAbsentIsSaid) {
  expect_complaint("run openni: -o map.ovimap",
                   {"no OpenNI camera is plugged in", "docs/cameras.md"});
  expect_complaint("run openni:1d27/0609@1/9 -o map.ovimap", {"1d27/0609@1/9", "cannot be opened"});
  plug_in();
  expect_complaint("run openni: --frames 3:9 -o map.ovimap", {"--frames"});
  expect_complaint("run openni: --poses given -o map.ovimap", {"--poses"});
  expect_complaint("run openni: --pictures p -o map.ovimap", {"--pictures"});
  write_text(path("libOpenNI2.so.0"), "no library");
  ::setenv("LD_LIBRARY_PATH", folder_.path().c_str(), 1);
  expect_complaint("run openni: -o map.ovimap",
                   {"libOpenNI2.so.0", "apt-get install libopenni2-0"});
}

TEST_F(OpenNiProgramTest, ServesWhileACameraIsMapped) {
  plug_in();
  const ProgramResult result =
      interrupted("serve --live openni: --set map.voxel_size_m=0.02 --port 0 --json -o map.ovimap",
                  "map.ovimap");
  EXPECT_EQ(result.code, 1) << result.err;
  EXPECT_NE(result.err.find("was unplugged"), std::string::npos) << result.err;
  EXPECT_GT(run_json("info map.ovimap --json")["frames"], 0);
}

}  // namespace
}  // namespace ovimap
