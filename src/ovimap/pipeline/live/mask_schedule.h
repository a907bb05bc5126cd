// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/frames/frame/frame.h"
#include "ovimap/map/voxels/voxel_map.h"
#include "ovimap/pipeline/mapping/picture_motion.h"

namespace ovimap {

class ConfigFields;

enum class MaskRule {
  kNeed,      ///< where surface in view has no label yet, or the camera has moved on
  kInterval,  ///< every n-th frame (the paper: every 30th at 30 frames a second)
};

struct MaskScheduleConfig {
  MaskRule rule = MaskRule::kNeed;
  int interval = 30;  ///< kInterval: frames
  float unexplained_share =
      0.25f;            ///< kNeed: share of the view without a label that asks for masks
  float motion = 0.1f;  ///< ... or this much motion since the last masks (MaskMotion)
  int min_gap = 5;      ///< ... but not before this many frames
};
void list_fields(MaskScheduleConfig& config, ConfigFields& fields);

/// Says which frames are worth the time of a mask network.
class MaskSchedule {
 public:
  explicit MaskSchedule(const MaskScheduleConfig& config)
      : config_(config), motion_(config.motion) {}

  /// Whether the frame should get masks. Call for every frame, in order.
  bool wants(const Frame& frame, const VoxelMap& map);
  /// The frame that was asked about got its masks, or is on its way to.
  void chosen();
  /// It did not get any after all: with kNeed, what it was chosen for is still needed.
  void went_without();

 private:
  MaskScheduleConfig config_;
  MaskMotion motion_;
  std::int64_t frames_ = 0, last_ = 0;  ///< counted by `wants`
  bool any_ = false;                    ///< one was chosen and got masks
};

/// The share of a frame's valid depth that the map has no label for: new surface, or surface fused
/// without masks. Looks at every eighth pixel of every eighth row. 0 without valid depth.
float unexplained_share(const VoxelMap& map, const Frame& frame);

}  // namespace ovimap
