// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/sam/sam_network.h"

#include <gtest/gtest.h>

#include "ovimap/inference/models/onnx_fixture.h"
#include "ovimap/inference/models/sha256.h"
#include "ovimap/inference/models/test_support.h"

namespace ovimap {
namespace {

constexpr int kSide = 8, kGrid = 2;

/// A network with the inputs of transformers' exports, whose score is the sum of all labels.
class LabelSum {
 public:
  explicit LabelSum(const std::string& keys) : scratch_("sam_network") {
    OnnxGraph encoder;
    encoder.input("pixel_values", OnnxGraph::kFloat, {1, 3, kSide, kSide})
        .node("AveragePool", {"pixel_values"}, "image_embeddings",
              {OnnxGraph::list_attribute("kernel_shape", {4, 4}),
               OnnxGraph::list_attribute("strides", {4, 4})})
        .output("image_embeddings", {1, 3, kGrid, kGrid});
    OnnxGraph decoder;
    decoder.input("input_points", OnnxGraph::kFloat, {1, 1, kAnySize, 2})
        .input("input_labels", OnnxGraph::kInt64, {1, 1, kAnySize})
        .input("input_boxes", OnnxGraph::kFloat, {1, kAnySize, 4})
        .input("image_embeddings", OnnxGraph::kFloat, {1, 3, kGrid, kGrid})
        .node("Cast", {"input_labels"}, "labels", {OnnxGraph::number_attribute("to", 1)})
        .node("ReduceSum", {"labels"}, "sum", {OnnxGraph::number_attribute("keepdims", 0)})
        .node("ReduceSum", {"input_boxes"}, "boxes", {OnnxGraph::number_attribute("keepdims", 0)})
        .node("Add", {"sum", "boxes"}, "iou_scores")
        .node("ReduceMax", {"image_embeddings"}, "pred_masks",
              {OnnxGraph::list_attribute("axes", {1}), OnnxGraph::number_attribute("keepdims", 0)})
        .output("iou_scores", {})
        .output("pred_masks", {1, kGrid, kGrid});
    scratch_.write("encoder.onnx", encoder.file());
    scratch_.write("decoder.onnx", decoder.file());
    scratch_.write(
        "model.yaml",
        concat(
            "kind: sam\nname: n\nlicense: l\nsource: s\n"
            "input: {size: 8, resize: stretch, mean: [0, 0, 0], std: [1, 1, 1]}\n"
            "networks:\n"
            "  encoder: {file: encoder.onnx, inputs: {image: pixel_values}, outputs: {embedding: "
            "image_embeddings}}\n"
            "  decoder:\n    file: decoder.onnx\n"
            "    inputs: {embedding: image_embeddings, points: input_points, labels: input_labels, "
            "boxes: input_boxes}\n"
            "    outputs: {masks: pred_masks, scores: iou_scores}\n",
            keys, "sha256:\n  encoder.onnx: ", sha256_of_file(scratch_.path() / "encoder.onnx"),
            "\n  decoder.onnx: ", sha256_of_file(scratch_.path() / "decoder.onnx"), "\n"));
  }

  float score(const PromptPoints& prompt) const {
    const SamNetwork network(read_model_folder(scratch_.path()), {});
    const ImageFeatures features = network.encode(RgbImage(kSide, kSide, Rgb8{9, 9, 9}));
    return network.decode(features, {&prompt, 1}).front().predicted_iou.front();
  }
  const std::filesystem::path& path() const { return scratch_.path(); }

 private:
  ScratchFolder scratch_;
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
