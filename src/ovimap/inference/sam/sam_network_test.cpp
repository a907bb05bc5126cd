// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/sam/sam_network.h"

#include <gtest/gtest.h>

#include "ovimap/inference/sam/sam_fixture.h"

namespace ovimap {
namespace {

using sam_fixture::kSide;
constexpr int kNetworkGrid = 2;

/// A network with the inputs of transformers' exports, whose score is the sum of all labels.
class LabelSum {
 public:
  explicit LabelSum(const std::string& keys) {
    OnnxGraph decoder = sam_fixture::decoder(kNetworkGrid);
    decoder.node("Cast", {"input_labels"}, "labels", {OnnxGraph::number_attribute("to", 1)})
        .node("ReduceSum", {"labels"}, "sum", {OnnxGraph::number_attribute("keepdims", 0)})
        .node("ReduceSum", {"input_boxes"}, "boxes", {OnnxGraph::number_attribute("keepdims", 0)})
        .node("Add", {"sum", "boxes"}, "iou_scores")
        .node("ReduceMax", {"image_embeddings"}, "pred_masks",
              {OnnxGraph::list_attribute("axes", {1}), OnnxGraph::number_attribute("keepdims", 0)})
        .output("iou_scores", {})
        .output("pred_masks", {1, kNetworkGrid, kNetworkGrid});
    sam_fixture::write_model(scratch_, kNetworkGrid, decoder, 0, keys);
  }

  float score(const PromptPoints& prompt) const {
    const SamNetwork network(read_model_folder(scratch_.path()), {});
    const ImageFeatures features = network.encode(RgbImage(kSide, kSide, Rgb8{9, 9, 9}));
    return network.decode(features, {&prompt, 1}).front().predicted_iou.front();
  }
  const std::filesystem::path& path() const { return scratch_.path(); }

 private:
  fixture::TemporaryFolder scratch_;
};

const PromptPoints kPoint = {{{1, 1}, PointLabel::kForeground}, {{0, 0}, PointLabel::kPadding}};
const PromptPoints kBox = {{{1, 1}, PointLabel::kForeground},
                           {{0, 0}, PointLabel::kBoxMin},
                           {{2, 2}, PointLabel::kBoxMax}};

TEST(SamNetwork, TakesWholeNumbersAsLabelsAndNoBoxes) {
  const LabelSum network("");
  EXPECT_EQ(network.score(kPoint), 1 - 1);
  EXPECT_EQ(network.score(kBox), 1 + 2 + 3);
}

TEST(SamNetwork, AsksForABoxByItsPointWhereCornersAreUnknown) {
  const LabelSum network("box_corners: false\n");
  EXPECT_EQ(network.score(kPoint), 1 - 1);
  EXPECT_EQ(network.score(kBox), 1 - 1);
}

TEST(SamNetwork, LeavesThePaddingToADecoderThatAddsIt) {
  const LabelSum network("box_corners: false\nadds_padding: true\n");
  EXPECT_EQ(network.score(kPoint), 1);
  EXPECT_EQ(network.score(kBox), 1);
}

TEST(SamNetwork, RefusesOtherWords) {
  const LabelSum network("adds_padding: maybe\n");
  EXPECT_TRUE(contains(error_of([&] { network.score(kPoint); }), "'adds_padding' is 'maybe'"));
}

}  // namespace
}  // namespace ovimap
