// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/sam/box_mask.h"

#include <gtest/gtest.h>

#include "ovimap/inference/models/onnx_fixture.h"
#include "ovimap/inference/models/sha256.h"
#include "ovimap/inference/models/test_support.h"

namespace ovimap {
namespace {

constexpr int kSide = 8, kGrid = 4;

/// A network that proposes for every box where the image is red, green and blue, and believes most
/// in the colour that there is most of.
SamNetwork color_network(const ScratchFolder& scratch) {
  OnnxGraph encoder;
  encoder.input("pixel_values", OnnxGraph::kFloat, {1, 3, kSide, kSide})
      .node("AveragePool", {"pixel_values"}, "image_embeddings",
            {OnnxGraph::list_attribute("kernel_shape", {2, 2}),
             OnnxGraph::list_attribute("strides", {2, 2})})
      .output("image_embeddings", {1, 3, kGrid, kGrid});
  OnnxGraph decoder;
  decoder.input("input_points", OnnxGraph::kFloat, {1, 1, kAnySize, 2})
      .input("input_labels", OnnxGraph::kInt64, {1, 1, kAnySize})
      .input("input_boxes", OnnxGraph::kFloat, {1, kAnySize, 4})
      .input("image_embeddings", OnnxGraph::kFloat, {1, 3, kGrid, kGrid})
      .node("Identity", {"image_embeddings"}, "pred_masks")
      .node("ReduceMean", {"image_embeddings"}, "iou_scores",
            {OnnxGraph::list_attribute("axes", {2, 3}), OnnxGraph::number_attribute("keepdims", 0)})
      .output("iou_scores", {1, 3})
      .output("pred_masks", {1, 3, kGrid, kGrid});
  scratch.write("encoder.onnx", encoder.file());
  scratch.write("decoder.onnx", decoder.file());
  scratch.write(
      "model.yaml",
      concat("kind: sam\nname: n\nlicense: l\nsource: s\n"
             "input: {size: 8, resize: stretch, mean: [100, 100, 100], std: [1, 1, 1]}\n"
             "networks:\n"
             "  encoder: {file: encoder.onnx, inputs: {image: pixel_values}, outputs: {embedding: "
             "image_embeddings}}\n"
             "  decoder:\n    file: decoder.onnx\n"
             "    inputs: {embedding: image_embeddings, points: input_points, labels: input_labels, "
             "boxes: input_boxes}\n"
             "    outputs: {masks: pred_masks, scores: iou_scores}\n",
             "sha256:\n  encoder.onnx: ", sha256_of_file(scratch.path() / "encoder.onnx"),
             "\n  decoder.onnx: ", sha256_of_file(scratch.path() / "decoder.onnx"), "\n"));
  return {read_model_folder(scratch.path()), {}};
}

TEST(MaskInBox, IsTheProposalThatTheNetworkBelievesInMost) {
  const ScratchFolder scratch("box_mask");
  const SamNetwork network = color_network(scratch);
  RgbImage image(16, 16, {0, 0, 0});
  fill_box(image, 0, 0, 8, 16, {255, 0, 0});
  fill_box(image, 12, 0, 16, 16, {0, 0, 255});
  const Image<std::uint8_t> mask =
      mask_in_box(network, network.encode(image), {Eigen::Vector2f(0, 0), Eigen::Vector2f(7, 15)}, 16, 16);
  EXPECT_EQ(mask.at(2, 3), 1);
  EXPECT_EQ(mask.at(5, 12), 1);
  EXPECT_EQ(mask.at(11, 3), 0) << "neither red nor most of the image";
  EXPECT_EQ(mask.at(14, 8), 0) << "blue";
}

}  // namespace
}  // namespace ovimap
