// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// Whole recordings through the program, held to thresholds: a rendered room with exact truth and a
// real kitchen. Each skips, saying why, when its data is absent.
#include "program_fixture.h"

namespace ovimap {
namespace {

const std::filesystem::path kFurniture = "/usr/share/sweethome3d/furniture";
const std::filesystem::path kKitchen = OVIMAP_SOURCE_DIR "/../shared/data/kitchen";

class EndToEndTest : public ProgramTest {
 protected:
  nlohmann::json scores(const std::string& masks) {
    EXPECT_EQ(run("run room/room --encoder none -o room.ovimap --masks " + masks).code, 0);
    return run_json("eval room.ovimap --gt room/room --json");
  }
};

TEST_F(EndToEndTest, TrueMasksRebuildTheFurnishedRoom) {
  if (!std::filesystem::is_directory(kFurniture))
    GTEST_SKIP() << "package sweethome3d-furniture is not installed";
  ASSERT_EQ(run("synth room --room tiny").code, 0);
  const auto truth_masks = scores("gt");
  const auto& agnostic = truth_masks["standard"]["class_agnostic"];
  EXPECT_GE(agnostic["ap50"].get<double>(), 0.85);
  EXPECT_GE(agnostic["miou"].get<double>(), 0.80);
  EXPECT_LE(truth_masks["standard"]["geometry"]["accuracy_m"].get<double>(), 0.005);
  EXPECT_GE(truth_masks["standard"]["geometry"]["completeness"].get<double>(), 0.98);

  const auto depth_alone = scores("none");
  EXPECT_GE(depth_alone["standard"]["class_agnostic"]["ap25"].get<double>(), 0.50);
  EXPECT_LT(depth_alone["standard"]["class_agnostic"]["ap50"].get<double>(),
            agnostic["ap50"].get<double>());
}

/// True masks on every so manieth frame, as another tool may leave them in a folder.
TEST_F(EndToEndTest, MasksOnFewFramesStillTellTheObjectsApart) {
  if (!std::filesystem::is_directory(kFurniture))
    GTEST_SKIP() << "package sweethome3d-furniture is not installed";
  ASSERT_EQ(run("synth room --room tiny").code, 0);
  ASSERT_EQ(run("masks room/room --masks gt -o all").code, 0);
  struct Expected {
    int every, mask_frames;
    double least_ap25;
  };
  double before = 1;
  for (const Expected& e :
       {Expected{1, 40, 0.85}, Expected{5, 8, 0.75}, Expected{11, 4, 0.4}, Expected{20, 2, 0.15}}) {
    const std::string folder = concat("every", e.every);
    std::filesystem::create_directories(path(folder));
    for (int i = 0; i < 40; i += e.every) {
      const std::string name = concat("/", i, ".png");
      std::filesystem::copy_file(path("all" + name), path(folder + name));
    }
    ASSERT_EQ(run("run room/room --encoder none -o room.ovimap --masks " + folder).code, 0);
    EXPECT_EQ(run_json("info room.ovimap --json")["mask_frames"], e.mask_frames);
    const double ap25 =
        run_json("eval room.ovimap --gt room/room --json")["standard"]["class_agnostic"]["ap25"];
    EXPECT_GE(ap25, e.least_ap25) << "every " << e.every;
    EXPECT_LE(ap25, before + 0.03) << "fewer masks, no better a map; every " << e.every;
    before = ap25;
  }
}

TEST_F(EndToEndTest, MapsTheRealKitchen) {
  if (!std::filesystem::is_directory(kKitchen))
    GTEST_SKIP() << "the kitchen recording is not beside the checkout";
  const auto report =
      run_json("run '" + kKitchen.string() + "' -o kitchen.ovimap --frames ::8 --json");
  EXPECT_EQ(report["frames"], 25);
  EXPECT_EQ(report["frames_skipped"], 0);
// Sanitizers keep as much again, and more, for themselves.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  EXPECT_LT(report["peak_rss_mb"].get<double>(), 600.0);
#endif
  const auto info = run_json("info kitchen.ovimap --json");
  // The table top is about 2.3 by 0.9 m: the object with most surface of about that size must be
  // there.
  const auto is_table = [](const nlohmann::json& instance) {
    const auto &low = instance["box"]["min"], &high = instance["box"]["max"];
    double longest = 0;
    for (int axis = 0; axis < 3; ++axis)
      longest = std::max(longest, high[axis].get<double>() - low[axis].get<double>());
    return longest > 1.5 && longest < 3.2 && instance["points"].get<int>() > 8000;
  };
  EXPECT_TRUE(std::any_of(info["instances"].begin(), info["instances"].end(), is_table));
}

TEST_F(EndToEndTest, CalibratesTheRealKitchen) {
  if (!std::filesystem::is_directory(kKitchen))
    GTEST_SKIP() << "the kitchen recording is not beside the checkout";
  std::filesystem::create_directories(path("kitchen"));
  for (const auto& entry : std::filesystem::directory_iterator(kKitchen))
    if (entry.path().filename() != "calibration.yaml")
      std::filesystem::create_symlink(std::filesystem::absolute(entry.path()),
                                      path("kitchen") / entry.path().filename());
  const auto found = run_json("calibrate kitchen --frames ::4 --json --picture edges.png");
  EXPECT_EQ(found["verdict"], "found");
  EXPECT_LT(found["found_px"].get<double>(), 0.7 * found["given_px"].get<double>());
  EXPECT_TRUE(std::filesystem::exists(path("edges.png")));
  EXPECT_EQ(run("check kitchen").code, 0);

  // From the calibration that was made by hand the same place is found.
  std::filesystem::copy_file(kKitchen / "calibration.yaml", path("kitchen/calibration.yaml"),
                             std::filesystem::copy_options::overwrite_existing);
  const auto by_hand = run_json("calibrate kitchen --frames ::4 --json -o found.yaml");
  EXPECT_EQ(by_hand["verdict"], "aligned");
  EXPECT_LT(found["found_px"].get<double>(), 1.03 * by_hand["given_px"].get<double>());
  for (const auto& moved : by_hand["moved"]) EXPECT_LT(moved["px"].get<double>(), 2);
}

}  // namespace
}  // namespace ovimap
