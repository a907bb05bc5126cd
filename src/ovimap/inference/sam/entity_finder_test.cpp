// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/sam/entity_finder.h"

#include <gtest/gtest.h>

#include <cmath>

#include "ovimap/base/error.h"
#include "ovimap/inference/models/onnx_fixture.h"
#include "ovimap/inference/models/sha256.h"
#include "ovimap/inference/models/test_support.h"
#include "ovimap/inference/sam/sam_network.h"

namespace ovimap {
namespace {

constexpr int kRows = 6, kColumns = 8, kCellPx = 5, kWidth = 40, kHeight = 30;

/// Maps on which nothing is seen yet.
class Drawn {
 public:
  Drawn() {
    maps_.rows = kRows;
    maps_.columns = kColumns;
    maps_.values.assign(FinderMaps::kMaps * kRows * kColumns, 0.f);
    maps_.image_from_cell = {kCellPx, kCellPx};
    for (int y = 0; y < kRows; ++y)
      for (int x = 0; x < kColumns; ++x) set(0, x, y, -10);
  }
  /// A thing that reaches so many cells to all sides and fills half its box.
  Drawn& thing(int x, int y, float depth_logit, float reach_cells) {
    set(0, x, y, depth_logit);
    for (int side = 1; side <= 4; ++side) set(side, x, y, std::log(reach_cells));
    return *this;
  }
  std::vector<MaskPrompt> things(const FinderConfig& config = {}) const {
    return things_in(maps_, kWidth, kHeight, config);
  }

 private:
  void set(int map, int x, int y, float value) {
    maps_.values[static_cast<std::size_t>((map * kRows + y) * kColumns + x)] = value;
  }
  FinderMaps maps_;
};

TEST(ThingsIn, APeakIsAThingWithItsBox) {
  const auto things = Drawn().thing(3, 2, 1, 2).things();
  ASSERT_EQ(things.size(), 1u);
  EXPECT_EQ(things[0].interior_px, Eigen::Vector2f(17, 12));
  EXPECT_TRUE(things[0].extent_px.min().isApprox(Eigen::Vector2f(7, 2), 1e-5f));
  EXPECT_TRUE(things[0].extent_px.max().isApprox(Eigen::Vector2f(27, 22), 1e-5f));
  EXPECT_NEAR(things[0].area_px, 200, 1);
  EXPECT_TRUE(things[0].known);
}

TEST(ThingsIn, BoxesEndAtTheImage) {
  const auto things = Drawn().thing(7, 5, 1, 4).things();
  ASSERT_EQ(things.size(), 1u);
  EXPECT_EQ(things[0].extent_px.max(), Eigen::Vector2f(kWidth - 1, kHeight - 1));
}

TEST(ThingsIn, TheSurestComeFirstAndNoMoreThanAsked) {
  Drawn drawn;
  drawn.thing(1, 1, 0.5f, 1).thing(4, 4, 3, 1).thing(6, 1, 2, 1);
  const auto all = drawn.things();
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[0].interior_px, Eigen::Vector2f(22, 22));
  EXPECT_EQ(all[1].interior_px, Eigen::Vector2f(32, 7));
  EXPECT_EQ(drawn.things({.max_prompts = 2}).size(), 2u);
  EXPECT_EQ(drawn.things({.min_depth = 0.7f}).size(), 2u);
}

TEST(ThingsIn, OfTwoWithOneBoxTheSurerCounts) {
  Drawn drawn;
  drawn.thing(2, 2, 2, 20).thing(5, 3, 1, 20);  // both boxes are the image
  const auto things = drawn.things();
  ASSERT_EQ(things.size(), 1u);
  EXPECT_EQ(things[0].interior_px, Eigen::Vector2f(12, 12));
}

TEST(ThingsIn, AbsurdDistancesAreBounded) {
  const auto things = Drawn().thing(2, 2, 2, 1e30f).things();
  ASSERT_EQ(things.size(), 1u);
  EXPECT_TRUE(things[0].extent_px.sizes().allFinite());
}

/// A model whose finder gives its embedding back.
class Mirror {
 public:
  explicit Mirror(int maps) : scratch_("entity_finder") {
    OnnxGraph graph;
    graph.input("embedding", OnnxGraph::kFloat, {1, maps, kAnySize, kAnySize})
        .node("Identity", {"embedding"}, "things")
        .output("things", {1, maps, kAnySize, kAnySize});
    scratch_.write("finder.onnx", graph.file());
    scratch_.write("model.yaml",
                   concat("kind: sam\nname: n\nlicense: l\nsource: s\n"
                          "input: {size: 16, resize: long_side, mean: [0, 0, 0], std: [1, 1, 1]}\n"
                          "networks:\n  finder: {file: finder.onnx, inputs: {embedding: embedding}, "
                          "outputs: {things: things}}\nsha256:\n  finder.onnx: ",
                          sha256_of_file(scratch_.path() / "finder.onnx"), "\n"));
  }
  EntityFinder finder() const { return {read_model_folder(scratch_.path()), {}}; }

 private:
  ScratchFolder scratch_;
};

TEST(EntityFinder, LooksAtWhatTheImageFills) {
  FloatTensor embedding{{1, 6, 4, 4}, {}};
  for (int i = 0; i < 6 * 16; ++i) embedding.values.push_back(static_cast<float>(i));
  // An image of 32 x 18: the input's 16 x 9 pixels, which is the embedding's 4 x 3.
  const FinderMaps maps = Mirror(6).finder().look(embedding, {16, 9, {0.5f, 0.5f}});
  EXPECT_EQ(maps.columns, 4);
  EXPECT_EQ(maps.rows, 3);
  EXPECT_EQ(maps.image_from_cell, Eigen::Vector2f(8, 8));
  ASSERT_EQ(maps.values.size(), 6u * 12u);
  EXPECT_EQ(maps.values[12], 16);  // the second map's first
}

TEST(EntityFinder, RefusesAnotherNumberOfMaps) {
  EXPECT_THROW(Mirror(5).finder(), Error);
}

TEST(EntityFinder, SeesTheGoldenMug) {
  const ModelFolder model = read_model_folder(inference_testdata() / "golden_sam" / "finder");
  ASSERT_TRUE(EntityFinder::is_in(model));
  RgbImage image(64, 32, Rgb8{40, 40, 40});
  fill_box(image, 16, 8, 28, 20, Rgb8{60, 90, 220});
  const SamNetwork network(model, {});
  const ImageFeatures features = network.encode(image);
  const FinderMaps maps =
      EntityFinder(model, {}).look(network.embedding(features), features.frame);
  const auto things = things_in(maps, 64, 32, {});
  ASSERT_EQ(things.size(), 1u);
  EXPECT_EQ(things[0].interior_px, Eigen::Vector2f(21.5f, 13.5f));
  EXPECT_NEAR(things[0].extent_px.volume(), 144, 1);
}

}  // namespace
}  // namespace ovimap
