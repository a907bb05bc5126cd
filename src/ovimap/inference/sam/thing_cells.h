// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "ovimap/inference/masks/mask_source.h"
#include "ovimap/inference/sam/sam_config.h"

namespace ovimap {

/// What a finder says of every cell of an image, row by row: maps x rows x columns, as logits of
/// how deep in its thing the cell lies (1 in the thing's middle, 0 at its border), logarithms of
/// the distances in cells to the left, upper, right and lower side of the thing's box, and the
/// logit of the share of that box which it fills. Where it gives masks as well, its kernels are a
/// weight of each image of the basis, kPlaceTerms terms of place and the logit of the mask's IoU,
/// kernels x rows x columns; the basis is images x 2 rows x 2 columns (thing_masks.h).
struct FinderMaps {
  static constexpr int kMaps = 6, kPlaceTerms = 5;
  int rows = 0, columns = 0;
  std::vector<float> values;                 ///< kMaps x rows x columns
  Eigen::Vector2f image_from_cell = {1, 1};  ///< pixels of the image a cell is wide and high
  std::vector<float> kernels, basis;         ///< empty: this finder gives no masks
  int whole_columns = 0;                     ///< of cells, were the network's input filled
};

/// An image in cells, each of which says how deep it lies in its thing and where the thing's box
/// is.
class ThingCells {
 public:
  /// Of an image of width_px x height_px, at which boxes end.
  ThingCells(const FinderMaps& maps, int width_px, int height_px);

  int rows() const { return rows_; }
  int columns() const { return columns_; }
  /// From 0 at a thing's border to 1 in its middle.
  float depth(int x, int y) const { return depths_[index(x, y)]; }
  /// The cell's thing, asked for at the cell's middle.
  MaskPrompt thing_at(int x, int y) const;

  /// How well `box` is that of the things in which the `chosen` cells lie: the overlap of the
  /// boxes, the mean over these cells by their depth; from 0 to 1, and 0 of no cells.
  float agreement(std::span<const Eigen::Vector2i> chosen, const Eigen::AlignedBox2f& box) const;

  /// The middle of a cell, in pixels of the image.
  Eigen::Vector2f middle_px(int x, int y) const;

 private:
  std::size_t index(int x, int y) const { return static_cast<std::size_t>(y * columns_ + x); }

  int rows_ = 0, columns_ = 0;
  Eigen::Vector2f image_from_cell_ = {1, 1};
  std::vector<float> depths_, filled_;
  std::vector<Eigen::AlignedBox2f> boxes_;
};

/// What a finder sees: where to ask for it, and the cell of its middle.
struct Thing {
  MaskPrompt prompt;
  Eigen::Vector2i cell = {0, 0};
};

/// The things whose middles the cells show, the surest first, at most `max_prompts`: where a cell
/// lies deeper than its neighbours and at least `min_depth` deep. Of two whose boxes are nearly the
/// same the surer one.
std::vector<Thing> things_in(const ThingCells& cells, const FinderConfig& config);

}  // namespace ovimap
