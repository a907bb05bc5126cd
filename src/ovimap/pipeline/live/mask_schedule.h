// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "ovimap/frames/frame/frame.h"
#include "ovimap/map/voxels/voxel_map.h"

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
      0.25f;               ///< kNeed: share of the view without a label that asks for masks
  float move_m = 0.25f;    ///< ... or this much motion since the last frame with masks
  float turn_rad = 0.26f;  ///< ... or this much turning (15 degrees)
  int min_gap = 5;         ///< ... but not before this many frames
};
void list_fields(MaskScheduleConfig& config, ConfigFields& fields);

/// Says which frames are worth the time of a mask network.
class MaskSchedule {
 public:
  explicit MaskSchedule(const MaskScheduleConfig& config) : config_(config) {}

  /// Whether the frame should get masks. Call for every frame, in order.
  bool wants(const Frame& frame, const VoxelMap& map);
  /// The frame got its masks, or is on its way to.
  void chosen(const Frame& frame);
  /// It did not get any after all: with kNeed, what it was chosen for is still needed.
  void went_without();

 private:
  bool moved(const Frame& frame) const;

  MaskScheduleConfig config_;
  std::int64_t frames_ = 0, last_ = 0;  ///< counted by `wants`
  std::optional<Pose> last_pose_;  ///< of the last frame with masks; empty: the next one needs them
};

/// The share of a frame's valid depth that the map has no label for: new surface, or surface fused
/// without masks. Looks at every eighth pixel of every eighth row. 0 without valid depth.
float unexplained_share(const VoxelMap& map, const Frame& frame);

}  // namespace ovimap
