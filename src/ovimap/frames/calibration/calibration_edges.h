// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ovimap/frames/frame/frame.h"

namespace ovimap {

class ConfigFields;

struct CalibrationEdgesConfig {
  float jump_m = 0.04f;        ///< a surface that much nearer than what is beside it has an edge,
  float jump_share = 0.04f;    ///< with this share of its depth added
  float max_hole = 0.025f;     ///< depth may be missing behind an edge for this share of the width
  int max_points = 4000;       ///< edge points of a frame
  float color_share = 0.10f;   ///< of the pixels with the strongest colour steps may be edges
  float min_color_step = 6.f;  ///< of 255; weaker ones are no edges
  float reach = 0.05f;  ///< distances to colour edges are known up to this share of the width
};
void list_fields(CalibrationEdgesConfig& config, ConfigFields& fields);

/// What a border of a surface separates: things side by side, or one above the other.
enum class EdgeSide : std::uint8_t { kBeside = 0, kAbove = 1 };

/// A point on the border of the nearer surface.
struct DepthEdge {
  Eigen::Vector3f x_in_depth;
  Eigen::Vector3f outwards;  ///< by which the point moves when the edge moves outwards by a pixel
  EdgeSide side;
};

/// The edges of one frame: of depth as points in space, of colour as a field of distances.
struct CalibrationEdges {
  static constexpr float kStepsPerPixel = 8;  ///< of the stored distances

  std::vector<DepthEdge> depth;
  std::array<Image<std::uint8_t>, 2> color_distance;  ///< by EdgeSide
};

CalibrationEdges find_calibration_edges(const Frame& frame, const CalibrationEdgesConfig& config);

}  // namespace ovimap
