// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/sam/box_mask.h"

#include <algorithm>

#include "ovimap/inference/masks/logit_grid.h"

namespace ovimap {

Image<std::uint8_t> mask_in_box(const SamNetwork& network, const ImageFeatures& features,
                                const Eigen::AlignedBox2f& box_px, int width, int height) {
  const PromptPoints box = {{box_px.min(), PointLabel::kBoxMin},
                            {box_px.max(), PointLabel::kBoxMax}};
  const MaskProposals proposals = network.decode(features, {&box, 1}).front();
  const auto best =
      std::max_element(proposals.predicted_iou.begin(), proposals.predicted_iou.end()) -
      proposals.predicted_iou.begin();
  const auto area =
      static_cast<std::size_t>(proposals.grid_size) * static_cast<std::size_t>(proposals.grid_size);
  const std::span<const float> logits(
      proposals.logits.data() + static_cast<std::size_t>(best) * area, area);
  const LogitGrid grid =
      logit_grid(features.frame, network.input_size_px(), network.grid_size(), width, height);
  Image<std::uint8_t> mask(width, height);
  for (int y = 0; y < height; ++y) {
    const LogitRow row(logits, grid, y);
    for (int x = 0; x < width; ++x) mask.at(x, y) = row.at(x) > 0;
  }
  return mask;
}

}  // namespace ovimap
