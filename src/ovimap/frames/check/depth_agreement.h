// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "ovimap/frames/frame/camera_rig.h"
#include "ovimap/frames/frame/frame.h"

namespace ovimap {

/// The geometry of a frame at reduced resolution: every n-th pixel, so that no depth is invented.
struct ThinFrame {
  std::int64_t position = 0;  ///< in its source
  PinholeCamera camera;
  DepthImage depth;
  Pose world_from_camera;
};

/// Keeps every n-th pixel, the smallest n that makes the image at most `max_width_px` wide.
ThinFrame thin_frame(const Frame& frame, int max_width_px);

/// A way in which poses, depth and camera may have been meant, other than as read.
struct Reinterpretation {
  PoseConvention::Direction direction = PoseConvention::Direction::kWorldFromCamera;
  PoseConvention::Axes axes = PoseConvention::Axes::kOpenCv;
  double depth_factor = 1;  ///< true depth / depth as read
  double focal_factor = 1;  ///< true focal length / focal length as read

  Pose pose(const Pose& as_read) const;
};

/// The usual mistakes; the first entry is "as read".
std::vector<Reinterpretation> usual_reinterpretations();

/// How well the depth images of pairs of frames agree when one is projected into the other.
struct Agreement {
  std::int64_t points = 0;    ///< projected
  std::int64_t compared = 0;  ///< of these, landed on a valid depth
  std::int64_t agreeing = 0;  ///< of these, within the tolerance

  double overlap() const { return points > 0 ? double(compared) / double(points) : 0; }
  double share() const { return compared > 0 ? double(agreeing) / double(compared) : 0; }
};

/// Sums over all pairs, each in both directions. `tolerance` is relative to the distance.
Agreement measure_agreement(const std::vector<std::pair<ThinFrame, ThinFrame>>& pairs,
                            const Reinterpretation& reading, double tolerance);

}  // namespace ovimap
