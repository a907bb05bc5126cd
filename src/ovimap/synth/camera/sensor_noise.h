// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "ovimap/synth/render/renderer.h"

namespace ovimap {

class ConfigFields;

/// A structured-light depth camera: sigma_z = base + growth (z - nearest)^2 (Nguyen, Izadi, Lovell,
/// "Modeling Kinect sensor noise", 2012), disparities in steps of an eighth of a pixel, sideways
/// jitter at outlines, no answer at depth edges, at grazing angles and out of range. By default its
/// errors are independent, which is what estimators assume and no real sensor does: correlation_px
/// and lens_bias_px make them less kind.
struct SensorNoiseConfig {
  float sigma_base_m = 0.0012f;
  float sigma_growth_per_m = 0.0019f;
  float sigma_nearest_m = 0.4f;
  float lateral_sigma_px = 0.5f;
  float focal_baseline_px_m = 43.5f;  ///< focal length times baseline: disparity = this / depth
  float disparity_step_px = 0.125f;
  /// Disparities are matched over windows of this width, so that neighbours err alike: depth noise
  /// and sideways jitter change as smoothly. 0: each pixel errs by itself.
  float correlation_px = 0.f;
  /// What a lens that nobody calibrated adds to disparities: a smooth field, the same in each
  /// frame, of this size. 0.1 is 2 cm at 3 m (z^2 / focal_baseline_px_m).
  float lens_bias_px = 0.f;
  float edge_jump = 0.03f;         ///< of the depth, between neighbours: an edge
  float edge_loss = 0.6f;          ///< share of edge pixels without an answer
  float grazing_start_cos = 0.3f;  ///< from here answers get rarer
  float grazing_end_cos = 0.08f;   ///< from here there are none
  float random_loss = 0.001f;      ///< share of other pixels without an answer
  float min_depth_m = 0.3f, max_depth_m = 6.f;
  float color_sigma = 2.f;         ///< of 255
  float position_sigma_m = 0.f;    ///< of the given pose against the true one, each axis
  float rotation_sigma_rad = 0.f;  ///< likewise, about each axis
};
void list_fields(SensorNoiseConfig& config, ConfigFields& fields);

/// Depth as such a camera gives it; 0 where it has no answer. The same seed gives the same image.
DepthImage noisy_depth(const RenderedView& view, const SensorNoiseConfig& config,
                       std::uint64_t seed);

RgbImage noisy_color(const RgbImage& color, const SensorNoiseConfig& config, std::uint64_t seed);

Pose noisy_pose(const Pose& pose, const SensorNoiseConfig& config, std::uint64_t seed);

}  // namespace ovimap
