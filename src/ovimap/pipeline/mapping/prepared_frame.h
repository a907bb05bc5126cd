// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "ovimap/base/stage_timers.h"
#include "ovimap/frames/frame/registration.h"
#include "ovimap/inference/masks/mask_source.h"
#include "ovimap/pipeline/mapping/mapper_config.h"

namespace ovimap {

/// What a depth image tells.
struct DepthReading {
  DepthSurface surface;
  DepthEstimate estimate;
};

/// What can be said of a frame without the map.
struct PreparedFrame {
  std::shared_ptr<const Frame> frame;
  Registration registration;
  DepthSurface surface;
  DepthEstimate estimate;  ///< what is fused
  RgbImage color;          ///< registered to the depth
  /// Of the depth with what was taken out of the frame (Frame::taken_out), where something was: for
  /// what moves and what is empty.
  std::optional<DepthReading> whole = std::nullopt;
  Image<float> free_m;  ///< free_depth of the same; empty where nobody asks for it
};

PreparedFrame prepare_frame(std::shared_ptr<const Frame> frame, const MapperConfig& config,
                            StageTimers& timers);

/// The pieces of a frame that are lifted to 3D, and what they were cut from.
struct FrameSegments {
  Segments segments;
  int regions = 0;      ///< geometric regions
  int entities = 0;     ///< 2D entities
  bool masked = false;  ///< 2D masks had a say
  bool blank = false;   ///< and tell nothing: no entity at all, or one that is all of the picture
};

/// Cuts the frame by depth and, unless `masks` is null, by its 2D entities; nullopt when the source
/// has no masks of this frame, which then is no evidence of what objects there are. Does not look
/// at the map. Throws what the mask source throws.
std::optional<FrameSegments> cut_segments(const PreparedFrame& prepared, MaskSource* masks,
                                          const MapperConfig& config, StageTimers& timers);

}  // namespace ovimap
