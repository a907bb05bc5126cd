// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "ovimap/frames/check/source_check.h"

namespace ovimap {

struct ThinFrame;

/// Poses that belong to the images of other frames, as when two clocks differ.
struct PoseOffset {
  std::int64_t frames = 0;  ///< the pose of an image is stored so many frames later; 0: at its own
  double seconds = 0;       ///< the same by the source's time stamps
  double agreement = 0;     ///< of the depth of neighbours with these poses
};

/// The offset at which the depth of neighbours agrees best, of a few frames to either side. Reads
/// the frames that have those poses.
PoseOffset find_pose_offset(const FrameSource& source,
                            const std::vector<std::pair<ThinFrame, ThinFrame>>& neighbours,
                            const SourceCheckConfig& config);

}  // namespace ovimap
