// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "ovimap/frames/check/capture_check.h"
#include "ovimap/frames/check/depth_agreement.h"
#include "ovimap/frames/check/edge_alignment.h"
#include "ovimap/frames/check/source_check.h"

namespace ovimap {

/// The frames that a check looks at: read once each, kept thin.
struct CheckSample {
  std::map<std::int64_t, std::optional<ThinFrame>> frames;  ///< by position; nullopt: unusable
  std::map<std::int64_t, std::string> faults;               ///< of the unusable ones
  std::map<std::int64_t, Capture> captures;                 ///< of the others
  std::vector<std::pair<ThinFrame, ThinFrame>> neighbours;  ///< with limited rotation between them
  bool registered = true;                                   ///< colour and depth share one camera
  EdgeAlignment alignment;                                  ///< of every second frame

  explicit CheckSample(const EdgeAlignmentConfig& config) : alignment(config) {}
};

/// Draws evenly spaced pairs of neighbours; of a short source all frames are read.
CheckSample draw_sample(const FrameSource& source, const SourceCheckConfig& config);

}  // namespace ovimap
