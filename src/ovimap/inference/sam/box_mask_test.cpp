// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/sam/box_mask.h"

#include <gtest/gtest.h>

#include "ovimap/inference/sam/sam_fixture.h"

namespace ovimap {
namespace {

constexpr int kGrid = 4;

/// A network that proposes for every box where the image is red, green and blue, and believes most
/// in the colour that there is most of.
SamNetwork color_network(const fixture::TemporaryFolder& scratch) {
  OnnxGraph decoder = sam_fixture::decoder(kGrid);
  decoder.node("Identity", {"image_embeddings"}, "pred_masks")
      .node("ReduceMean", {"image_embeddings"}, "iou_scores",
            {OnnxGraph::list_attribute("axes", {2, 3}), OnnxGraph::number_attribute("keepdims", 0)})
      .output("iou_scores", {1, 3})
      .output("pred_masks", {1, 3, kGrid, kGrid});
  sam_fixture::write_model(scratch, kGrid, decoder, 100);
  return {read_model_folder(scratch.path()), {}};
}

TEST(MaskInBox, IsTheProposalThatTheNetworkBelievesInMost) {
  const fixture::TemporaryFolder scratch;
  const SamNetwork network = color_network(scratch);
  RgbImage image(16, 16, {0, 0, 0});
  fill_box(image, 0, 0, 8, 16, {255, 0, 0});
  fill_box(image, 12, 0, 16, 16, {0, 0, 255});
  const Image<std::uint8_t> mask = mask_in_box(
      network, network.encode(image), {Eigen::Vector2f(0, 0), Eigen::Vector2f(7, 15)}, 16, 16);
  EXPECT_EQ(mask.at(2, 3), 1);
  EXPECT_EQ(mask.at(5, 12), 1);
  EXPECT_EQ(mask.at(11, 3), 0) << "neither red nor most of the image";
  EXPECT_EQ(mask.at(14, 8), 0) << "blue";
}

}  // namespace
}  // namespace ovimap
