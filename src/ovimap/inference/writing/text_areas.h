// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "ovimap/image/image.h"

namespace ovimap {

/// A line of writing: a rectangle in an image, pixel centres at whole numbers.
struct TextArea {
  Eigen::Vector2f center_px = Eigen::Vector2f::Zero();
  Eigen::Vector2f along = Eigen::Vector2f::UnitX();  ///< unit length, the way the line runs
  float length_px = 0, height_px = 0;                ///< along the line, and across
};

/// How a network's shrunken text areas become rectangles (Liao et al. 2020, "Real-time scene text
/// detection with differentiable binarization", sections 3.4 and 4.2).
struct TextAreaRule {
  float pixel_level = 0.3f;  ///< probability that makes a pixel part of an area
  float area_level = 0.5f;   ///< mean probability that makes an area text
  float growth = 1.6f;       ///< areas were learned shrunken: grown by growth * area / outline
  int least_px = 3;          ///< thinner areas are noise
};

/// The smallest rectangle around each connected area that the network takes for text, from the top
/// down. Lines run along the longer side, towards the right; those that stand upright, upwards.
std::vector<TextArea> find_text_areas(const Image<float>& probability, const TextAreaRule& rule);

}  // namespace ovimap
