// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "ovimap/frames/calibration/calibration_fit.h"
#include "ovimap/frames/frame/frame_source.h"

namespace ovimap {

struct ColorCalibrationConfig {
  int max_frames = 100;        ///< frames read, evenly spaced
  int min_frames = 8;          ///< fewer, from different places, tell nothing
  int min_edges = 2000;        ///< fewer points on edges of depth tell nothing
  int min_cells = 5;           ///< of the image's 3x3 cells must hold a fair share of them
  float min_move_m = 0.01f;    ///< a frame that moved less than this from the one before,
  float min_turn_rad = 0.01f;  ///< and turned less than this, says the same again
  float aligned = 0.0015f;  ///< colour off by less (share of the width), or by less than the halves
                            ///< of the frames differ, is where it should be
  float max_spread = 0.005f;   ///< the halves of the frames must agree to this share of the width
  float min_sharpness = 0.1f;  ///< edges must meet so much worse when colour is off by 1%
  float min_gain = 0.01f;      ///< and so much better than as given; with a lens, than without
  CalibrationEdgesConfig edges;
  CalibrationFitConfig fit;
};
void list_fields(ColorCalibrationConfig& config, ConfigFields& fields);

/// Where colour lies, found by aligning its edges with those of depth.
struct ColorCalibration {
  enum class Verdict {
    kFound,    ///< `found` is better than what is given
    kAligned,  ///< what is given is right
    kRefused,  ///< the recording does not tell; `message` says why, and what would
  };
  Verdict verdict = Verdict::kRefused;
  std::string message;                  ///< one line
  std::vector<std::int64_t> positions;  ///< of the frames that were used
  std::size_t edges = 0;                ///< points on edges of depth, of all frames
  PinholeCamera depth_camera;
  ColorView given, found;

  /// Mean distance of depth's edges from colour's, in colour pixels, far ones cut off; of
  /// `found_px` each half of the frames is judged in the view that the other half gave.
  double given_px = 0, found_px = 0;
  double spread_px = 0;  ///< how far the views of the two halves are apart, root mean square
  double sharpness = 0;  ///< by what share edges meet worse when colour moves by 1% of its width
};

/// Reads up to `max_frames` of the frames at `positions` and finds the colour camera and its offset
/// from the depth camera, starting at what the frames say and from other focal lengths and shifts;
/// and, where the source knows of no lens of the colour camera, the two radial coefficients of one,
/// if edges of frames that did not take part in finding them meet better with it.
/// The frames are fitted in two halves as well, apart in time: how well they agree tells how far
/// the result can be trusted. `progress` is called after each step. The poses tell only whether
/// the camera moved.
ColorCalibration calibrate_color(
    const FrameSource& source, const std::vector<std::int64_t>& positions,
    const ColorCalibrationConfig& config = {},
    const std::function<void(std::size_t done, std::size_t total)>& progress = {});

/// Root mean square distance, in colour pixels, between where two views put what fills the depth
/// image at `depth_m`.
double view_difference_px(const PinholeCamera& depth_camera, const ColorView& a, const ColorView& b,
                          float depth_m);

/// Depth's edges over the colour images of two frames, the middle ones of either half, one below
/// the other: as given at the left, as found at the right. Throws Error when a frame cannot be read
/// any more.
RgbImage calibration_picture(const FrameSource& source, const ColorCalibration& calibration,
                             const CalibrationEdgesConfig& config = {});

/// The calibration.yaml that is read with the recording at `source`.
std::filesystem::path calibration_file(const std::filesystem::path& source);

/// The text of a calibration.yaml with the colour camera found and its offset. Other keys are
/// those of `present` where that file exists. Throws Error when it is not YAML.
std::string calibrated_text(const std::filesystem::path& present,
                            const ColorCalibration& calibration);

}  // namespace ovimap
