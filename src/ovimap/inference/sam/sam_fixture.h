// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/inference/models/onnx_fixture.h"
#include "ovimap/inference/models/sha256.h"
#include "ovimap/inference/models/test_support.h"

namespace ovimap::sam_fixture {

constexpr int kSide = 8;

/// A decoder with the inputs of transformers' exports, for an embedding of `grid` x `grid`.
inline OnnxGraph decoder(int grid) {
  OnnxGraph graph;
  graph.input("input_points", OnnxGraph::kFloat, {1, 1, kAnySize, 2})
      .input("input_labels", OnnxGraph::kInt64, {1, 1, kAnySize})
      .input("input_boxes", OnnxGraph::kFloat, {1, kAnySize, 4})
      .input("image_embeddings", OnnxGraph::kFloat, {1, 3, grid, grid});
  return graph;
}

/// Writes the model folder of a network whose embedding is the image of kSide x kSide, made smaller
/// to `grid` x `grid`. mean: of all channels. keys: further lines of the decoder's part.
inline void write_model(const fixture::TemporaryFolder& scratch, int grid, OnnxGraph decoder,
                        int mean, const std::string& keys = "") {
  const auto step = static_cast<std::size_t>(kSide / grid);
  OnnxGraph encoder;
  encoder.input("pixel_values", OnnxGraph::kFloat, {1, 3, kSide, kSide})
      .node("AveragePool", {"pixel_values"}, "image_embeddings",
            {OnnxGraph::list_attribute("kernel_shape", {step, step}),
             OnnxGraph::list_attribute("strides", {step, step})})
      .output("image_embeddings", {1, 3, grid, grid});
  scratch.write("encoder.onnx", encoder.file());
  scratch.write("decoder.onnx", decoder.file());
  scratch.write(
      "model.yaml",
      concat(
          "kind: sam\nname: n\nlicense: l\nsource: s\n"
          "input: {size: ",
          kSide, ", resize: stretch, mean: [", mean, ", ", mean, ", ", mean,
          "], std: [1, 1, 1]}\n"
          "networks:\n"
          "  encoder: {file: encoder.onnx, inputs: {image: pixel_values}, outputs: {embedding: "
          "image_embeddings}}\n"
          "  decoder:\n    file: decoder.onnx\n"
          "    inputs: {embedding: image_embeddings, points: input_points, labels: input_labels, "
          "boxes: input_boxes}\n"
          "    outputs: {masks: pred_masks, scores: iou_scores}\n",
          keys, "sha256:\n  encoder.onnx: ", sha256_of_file(scratch.path() / "encoder.onnx"),
          "\n  decoder.onnx: ", sha256_of_file(scratch.path() / "decoder.onnx"), "\n"));
}

}  // namespace ovimap::sam_fixture
