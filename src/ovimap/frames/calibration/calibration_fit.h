// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "ovimap/frames/calibration/calibration_edges.h"
#include "ovimap/frames/frame/lens.h"

namespace ovimap {

/// Where colour is taken from: what a calibration looks for.
struct ColorView {
  PinholeCamera camera;
  Pose color_from_depth = Pose::Identity();
  Lens lens = {};  ///< that bends colour as it is read; of Brown and Conrady, radial alone

  /// Pixel of a point in the depth camera's frame; not finite behind the colour camera.
  Eigen::Vector2f project(const Eigen::Vector3f& x_in_depth) const;
};

struct CalibrationFitConfig {
  // How far the view may lie from the one that is given: standard deviations, loosely held.
  float focal_sigma = 0.15f;    ///< of the focal length, as a share
  float aspect_sigma = 0.003f;  ///< of fx / fy against the given
  float center_sigma = 0.03f;   ///< of the principal point, share of the width
  float rotation_sigma_rad = 0.03f;
  float translation_sigma_m = 0.04f;
  float radial_sigma = 0.3f;    ///< of either radial coefficient of a lens, where one is looked for
  float outset_sigma_px = 1.f;  ///< of how far depth's edges lie inside the true ones
  float prior_weight = 0.002f;  ///< of one deviation squared, against the mean of the edges' losses
  int starts = 6;               ///< views that are refined; 1: the given one, without a search
  int iterations = 25;          ///< of each level of each start
  int search_points = 2000;     ///< edges that the search for starts looks at,
  int final_points = 80000;     ///< and the last refinement,
  int start_points = 8000;      ///< and the refinement of starts
  float finest = 0.003f;        ///< reach of the last refinement, share of the width
  float truncation = 0.015f;    ///< edges farther off count as that far, share of the width
  float max_shift = 0.1f;       ///< of colour, that is tried, share of the width
  float max_scale = 1.3f;       ///< factor on the focal length that is tried, and its inverse
};
void list_fields(CalibrationFitConfig& config, ConfigFields& fields);

using EdgeFrames = std::vector<const CalibrationEdges*>;

/// A view with what the fit learns about depth's edges beside.
struct FittedView {
  ColorView view;
  float outset_px = 0;  ///< how far depth's edges lie inside the true ones, depth pixels
};

/// How well the frames' edges meet: the mean distance of depth's edges from colour's, pixels, each
/// at most `truncation_px`. Edges that the view does not see do not count; without any it is
/// `truncation_px`. Looks at every `stride`-th edge.
struct EdgeScore {
  double mean_px = 0;
  std::size_t edges = 0;  ///< in view
};
EdgeScore edge_score(const EdgeFrames& frames, const FittedView& fitted, float truncation_px,
                     std::size_t stride = 1);

/// The view in which the frames' edges meet best: a search over focal lengths and shifts finds
/// starts, each is refined by damped least squares from coarse to fine, and the best one wins. The
/// lens stays as given. Deterministic for any number of threads.
FittedView fit_color_view(const EdgeFrames& frames, const ColorView& given,
                          const CalibrationFitConfig& config);

/// Goes on from a view that was fitted without a lens, with k1 and k2 of Brown and Conrady's (1966)
/// as further unknowns.
FittedView fit_lens(const EdgeFrames& frames, const FittedView& straight,
                    const CalibrationFitConfig& config);

}  // namespace ovimap
