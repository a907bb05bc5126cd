// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "ovimap/frames/frame/frame.h"

namespace ovimap {

class ConfigFields;

struct EdgeAlignmentConfig {
  int max_shift_px = 40;      ///< shifts of the colour image that are tried
  int shift_step_px = 4;      ///< between them
  int edge_reach_px = 2;      ///< depth is compared over this distance
  float edge_step_m = 0.05f;  ///< a surface that much nearer than what is beside it has an edge,
  float edge_step_share = 0.05f;  ///< with this share of its depth added
  int max_gradient = 80;          ///< colour steps count up to this, of 510
  int min_edges = 300;            ///< a cell of the image with fewer edge pixels is not judged
  int min_misplaced_px = 8;       ///< colour that lies farther off is not registered
  float min_gain = 1.1f;          ///< colour steps must be so much stronger there
  float misplaced_cells = 0.5f;   ///< share of the judged cells that must be off
};
void list_fields(EdgeAlignmentConfig& config, ConfigFields& fields);

/// Whether colour lies where depth says. Where a surface ends before another, colour mostly changes
/// too: the mean colour step along depth edges is largest where the two images are brought
/// together. It is measured in 3x3 cells, because a wrong focal length shifts them apart.
class EdgeAlignment {
 public:
  static constexpr int kCells = 3;  ///< along each side

  explicit EdgeAlignment(const EdgeAlignmentConfig& config);

  /// Adds the edges of a frame; colour is looked up through the frame's cameras.
  void add(const Frame& frame);

  struct Cell {
    std::int64_t edges = 0;
    Eigen::Vector2i shift_px = Eigen::Vector2i::Zero();  ///< of the strongest colour steps
    double gain = 1;  ///< how much stronger they are there than where they should be
  };
  /// Row by row.
  std::vector<Cell> cells() const;

  struct Verdict {
    int judged = 0, misplaced = 0;  ///< cells
    double shift_px = 0;            ///< median length of the misplaced ones' shifts
    bool registered = true;
  };
  Verdict verdict() const;

 private:
  int shifts() const { return 2 * (config_.max_shift_px / config_.shift_step_px) + 1; }
  int shift_of(int step) const {
    return (step - config_.max_shift_px / config_.shift_step_px) * config_.shift_step_px;
  }

  EdgeAlignmentConfig config_;
  std::array<std::int64_t, kCells * kCells> edges_{};
  std::vector<std::int64_t> steps_;  ///< [cell, shift y, shift x] sums of colour steps
};

}  // namespace ovimap
