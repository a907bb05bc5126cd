// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// `--people`, with a detector that takes red for a person.
#include "ovimap/io/mesh/ply.h"
#include "program_fixture.h"

namespace ovimap {
namespace {

class PeopleProgramTest : public ProgramTest {
 protected:
  PeopleProgramTest() {
    const std::filesystem::path golden =
        OVIMAP_SOURCE_DIR "/src/ovimap/inference/testdata/golden_detector";
    std::filesystem::create_directories(path("models"));
    std::filesystem::copy(golden, path("models/red"));
    std::string model = slurp(path("models/red/model.yaml"));
    model.replace(model.find("  red;"), 6, "  person;");
    std::ofstream(path("models/red/model.yaml")) << model;
    for (int i = 0; i < sequence_.frames; ++i) paint(i);
  }
  /// Nothing in the room is red but the first quarter of every third image.
  void paint(int frame) const {
    RgbImage color = sequence_.color(frame);
    for (int v = 0; v < color.height(); ++v)
      for (int u = 0; u < color.width(); ++u) {
        Rgb8& pixel = color.at(u, v);
        pixel.r = 0;
        if (frame % 3 == 0 && 2 * u < color.width() && 2 * v < color.height()) pixel = {255, 0, 0};
      }
    write_file(path("recording") / ("frame-" + fixture::padded(frame, 6) + ".color.png"),
               encode_png(color));
  }
  /// Whether a map's surface is red anywhere.
  bool is_red(const std::string& map) const {
    EXPECT_EQ(run("export " + map + " surface.ply").code, 0);
    const Mesh mesh = read_ply(path("surface.ply"));
    EXPECT_FALSE(mesh.colors.empty());
    return std::any_of(mesh.colors.begin(), mesh.colors.end(),
                       [](const auto& color) { return color[0] > 100; });
  }
  static constexpr const char* kDrop =
      "run recording --people drop --model-dir models --set people.detector=red "
      "--set people.reach_m=10 --set people.seed_m=10 --set people.step_share=1 "  // the whole
                                                                                   // quarter
      "--set map.voxel_size_m=0.05 ";
};

TEST_F(PeopleProgramTest, TheyAreLeftOutAndCounted) {
  const auto kept = run_json("run recording --set map.voxel_size_m=0.05 -o kept.ovimap --json");
  EXPECT_FALSE(kept.contains("people_frames"));
  const auto dropped = run_json(std::string(kDrop) + "-o dropped.ovimap --json");
  EXPECT_EQ(dropped["people_frames"], 4);
  EXPECT_EQ(dropped["frames"], kept["frames"]);
  EXPECT_TRUE(is_red("kept.ovimap"));
  EXPECT_FALSE(is_red("dropped.ovimap"));
  const ProgramResult said = run(std::string(kDrop) + "-o again.ovimap");
  EXPECT_NE(said.out.find("left out people in 4 frames"), std::string::npos) << said.out;
  EXPECT_EQ(run_json("info again.ovimap --json")["content_hash"],
            run_json("info dropped.ovimap --json")["content_hash"]);
}

TEST_F(PeopleProgramTest, LiveAsWell) {
  const auto live = run_json(std::string(kDrop) + "--live --fps 20 -o live.ovimap --json");
  EXPECT_EQ(live["people_frames"], 4);
}

TEST_F(PeopleProgramTest, KeptFramesDoNotShowThemEither) {
  ASSERT_EQ(run(std::string(kDrop) + "--set frame_store.max_mb=100 -o map.ovimap").code, 0);
  std::string poses;
  for (int i = 0; i < sequence_.frames; ++i)
    poses += concat(i / 30., " ", fixture::tum_text(sequence_.pose(i)), "\n");
  write_text(path("poses.txt"), poses);
  const ProgramResult corrected = run("correct map.ovimap --poses poses.txt -o again.ovimap");
  ASSERT_EQ(corrected.code, 0) << corrected.err;
  EXPECT_FALSE(is_red("again.ovimap"));
}

TEST_F(PeopleProgramTest, WithoutADetectorOneLineSaysWhatToDo) {
  expect_complaint("run recording --people drop --set people.detector=absent -o map.ovimap",
                   {"'absent', which is not installed", "tools/setup.sh"});
}

}  // namespace
}  // namespace ovimap
