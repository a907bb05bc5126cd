// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/sam/entity_finder.h"

#include <gtest/gtest.h>

#include "ovimap/base/error.h"
#include "ovimap/inference/models/onnx_fixture.h"
#include "ovimap/inference/models/sha256.h"
#include "ovimap/inference/models/test_support.h"
#include "ovimap/inference/sam/sam_network.h"

namespace ovimap {
namespace {

/// The model folder of a finder alone. outputs, further_inputs: as model.yaml lists them.
void write_model(const fixture::TemporaryFolder& scratch, const std::string& network,
                 const std::string& outputs, const std::string& further_inputs = "") {
  scratch.write("finder.onnx", network);
  scratch.write("model.yaml",
                concat("kind: sam\nname: n\nlicense: l\nsource: s\n"
                       "input: {size: 16, resize: long_side, mean: [0, 0, 0], std: [1, 1, 1]}\n"
                       "networks:\n  finder: {file: finder.onnx, inputs: {embedding: embedding",
                       further_inputs, "}, outputs: {", outputs, "}}\nsha256:\n  finder.onnx: ",
                       sha256_of_file(scratch.path() / "finder.onnx"), "\n"));
}

/// A model whose finder gives its embedding back.
class Mirror {
 public:
  explicit Mirror(int maps) {
    OnnxGraph graph;
    graph.input("embedding", OnnxGraph::kFloat, {1, maps, kAnySize, kAnySize})
        .node("Identity", {"embedding"}, "things")
        .output("things", {1, maps, kAnySize, kAnySize});
    write_model(scratch_, graph.file(), "things: things");
  }
  EntityFinder finder() const { return {read_model_folder(scratch_.path()), {}}; }

 private:
  fixture::TemporaryFolder scratch_;
};

TEST(EntityFinder, LooksAtWhatTheImageFills) {
  FloatTensor embedding{{1, 6, 4, 4}, {}};
  for (int i = 0; i < 6 * 16; ++i) embedding.values.push_back(static_cast<float>(i));
  // An image of 32 x 18: the input's 16 x 9 pixels, which is the embedding's 4 x 3.
  const FinderMaps maps = Mirror(6).finder().look(embedding, {16, 9, {0.5f, 0.5f}}, {});
  EXPECT_EQ(maps.columns, 4);
  EXPECT_EQ(maps.rows, 3);
  EXPECT_EQ(maps.image_from_cell, Eigen::Vector2f(8, 8));
  ASSERT_EQ(maps.values.size(), 6u * 12u);
  EXPECT_EQ(maps.values[12], 16);  // the second map's first
}

TEST(EntityFinder, TakesAnEmbeddingOfTheRowsThatThereAre) {
  FloatTensor embedding{{1, 6, 3, 4}, std::vector<float>(6 * 12)};
  const FinderMaps maps = Mirror(6).finder().look(embedding, {16, 9, {0.5f, 0.5f}}, {});
  EXPECT_EQ(maps.columns, 4);
  EXPECT_EQ(maps.rows, 3);
  EXPECT_EQ(maps.image_from_cell, Eigen::Vector2f(8, 8));
}

TEST(EntityFinder, RefusesAnotherNumberOfMaps) {
  EXPECT_THROW(Mirror(5).finder(), Error);
}

TEST(EntityFinder, RefusesKernelsThatDoNotFitTheBasis) {
  const auto model_with = [](int kernels) {
    fixture::TemporaryFolder scratch;
    OnnxGraph graph;
    graph.input("embedding", OnnxGraph::kFloat, {1, 6, kAnySize, kAnySize})
        .node("Identity", {"embedding"}, "things")
        .node("Identity", {"embedding"}, "kernels")
        .node("Identity", {"embedding"}, "basis")
        .output("things", {1, 6, kAnySize, kAnySize})
        .output("kernels", {1, kernels, kAnySize, kAnySize})
        .output("basis", {1, 6, kAnySize, kAnySize});
    write_model(scratch, graph.file(), "things: things, kernels: kernels, basis: basis");
    return EntityFinder(read_model_folder(scratch.path()), {});
  };
  EXPECT_THROW(model_with(6), Error);  // a basis of 6 images wants 12
}

TEST(EntityFinder, RefusesAViewOfDepthOfAnotherNumberOfMaps) {
  const auto model_with = [](int maps) {
    fixture::TemporaryFolder scratch;
    OnnxGraph graph;
    graph.input("embedding", OnnxGraph::kFloat, {1, 6, kAnySize, kAnySize})
        .input("geometry", OnnxGraph::kFloat, {1, maps, kAnySize, kAnySize})
        .node("Identity", {"embedding"}, "things")
        .node("Identity", {"geometry"}, "seen")
        .output("things", {1, 6, kAnySize, kAnySize})
        .output("seen", {1, maps, kAnySize, kAnySize});
    write_model(scratch, graph.file(), "things: things", ", geometry: geometry");
    return EntityFinder(read_model_folder(scratch.path()), {});
  };
  EXPECT_NO_THROW(model_with(4));
  EXPECT_THROW(model_with(5), Error);
}

TEST(EntityFinder, SeesTheGoldenMug) {
  const ModelFolder model = read_model_folder(inference_testdata() / "golden_sam" / "finder");
  ASSERT_TRUE(EntityFinder::is_in(model));
  RgbImage image(64, 32, Rgb8{40, 40, 40});
  fill_box(image, 16, 8, 28, 20, Rgb8{60, 90, 220});
  const SamNetwork network(model, {});
  const ImageFeatures features = network.encode(image);
  const FinderMaps maps =
      EntityFinder(model, {}).look(network.embedding(features), features.frame, {});
  const auto things = things_in(ThingCells(maps, 64, 32), {});
  ASSERT_EQ(things.size(), 1u);
  EXPECT_EQ(things[0].prompt.interior_px, Eigen::Vector2f(21.5f, 13.5f));
  EXPECT_NEAR(things[0].prompt.extent_px.volume(), 144, 1);
}

}  // namespace
}  // namespace ovimap
