// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ovimap/frames/calibration/color_calibration.h"
#include "ovimap/frames/check/edge_alignment.h"
#include "ovimap/frames/frame/frame_source.h"

namespace ovimap {

struct SourceCheckConfig {
  int max_frames = 40;              ///< frames read, evenly spaced in pairs of neighbours
  float max_faulty_share = 0.5f;    ///< more unusable frames than this are a fault, fewer a warning
  float min_valid_share = 0.2f;     ///< fewer valid depth pixels than this are a warning
  float min_median_depth_m = 0.2f;  ///< a nearer median depth is suspicious
  float max_median_depth_m = 8.f;   ///< a farther median depth is suspicious
  int pair_gap = 10;  ///< frames between two neighbours, fewer when the camera turns fast
  float max_pair_rotation_deg = 15;  ///< two neighbours differ by at most this rotation
  int compared_width_px = 80;        ///< depth images are thinned to this width before comparing
  float depth_tolerance = 0.02f;     ///< depths agree within this share of the distance
  float min_overlap = 0.1f;          ///< less overlap between neighbours cannot be judged
  float min_agreement = 0.5f;        ///< less depth agreement is a fault
  float good_agreement = 0.7f;       ///< less depth agreement is a warning, and names no mistake
  float min_gain = 0.1f;  ///< another reading of poses or depth must agree better by this much
  EdgeAlignmentConfig alignment;                      ///< of colour and depth
  ColorCalibrationConfig lens = quick_calibration();  ///< whether colour's lens was left out

  /// Of fewer edges and from the given cameras on, without a search.
  static ColorCalibrationConfig quick_calibration();
};
void list_fields(SourceCheckConfig& config, ConfigFields& fields);

enum class Severity { kOk, kWarning, kFault };

/// One result of a check. `name` is stable, for programs: "frames", "bad_frames", "depth_valid",
/// "depth_scale", "poses" (there are none), "still_poses", "pose_convention", "pose_unit",
/// "intrinsics", "time_offset", "agreement", "registration", "lens", "clock", "blur", "noise".
struct Finding {
  Severity severity = Severity::kOk;
  std::string name;
  std::string message;  ///< one line, with the figures
  std::string remedy;   ///< what to do; empty when ok
};

/// How much depth errs at one distance, standard deviations along the optical axis.
struct DepthError {
  float distance_m = 0;
  float pixel_m = 0;    ///< of a pixel
  float surface_m = 0;  ///< of the surface through a window of pixels: what averages leave of it,
                        ///< since neighbours err alike
};

struct CheckReport {
  std::string kind;                ///< of the source
  std::int64_t frames = 0;         ///< in the source
  std::int64_t checked = 0;        ///< read for this check
  std::int64_t usable = 0;         ///< of those checked
  std::vector<FaultCount> faults;  ///< most frequent first
  double median_depth_m = 0;
  double valid_share = 0;      ///< of the depth pixels in usable frames
  double overlap = 0;          ///< share of depth pixels that neighbouring frames both see
  double depth_agreement = 0;  ///< share of those that agree, as read
  std::vector<DepthError> depth_errors;  ///< check_recording measures them
  std::vector<Finding> findings;

  /// No finding is a fault.
  bool ok() const;
};

/// Reads up to `max_frames` frames and says what is wrong with the recording: unusable frames,
/// depth in another unit, poses inverted or in other axes, poses that never change or belong to
/// other images, a wrong focal length, colour that does not lie where depth says, or whose lens
/// was left out. Depth of neighbouring frames is projected into each other; when the frames
/// disagree, the usual mistakes are tried and the one that fits clearly better is named with its
/// remedy. Without poses the rest is checked. Of no usable frame nothing more is said.
///
/// The source must not limit depth (check_recording).
CheckReport check_source(const FrameSource& source, const SourceCheckConfig& config = {});

}  // namespace ovimap
