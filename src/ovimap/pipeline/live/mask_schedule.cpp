// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/live/mask_schedule.h"

#include "ovimap/base/config.h"
#include "ovimap/map/rays/surface_lookup.h"
#include "ovimap/map/voxels/label_slots.h"

namespace ovimap {

void list_fields(MaskScheduleConfig& config, ConfigFields& fields) {
  fields.add_choice<MaskRule>("rule", config.rule,
                              {{"need", MaskRule::kNeed}, {"interval", MaskRule::kInterval}},
                              "which frames get 2D masks");
  fields.add("interval", config.interval, 1, 1000000, "rule interval: every n-th frame");
  fields.add("unexplained_share", config.unexplained_share, 0.f, 1.f,
             "rule need: share of the view without a label that asks for masks");
  fields.add("motion", config.motion, 0.f, 1.f,
             "... or what is in view moved by this share of the picture since the last masks");
  fields.add("min_gap", config.min_gap, 1, 1000000, "... but not before this many frames");
}

bool MaskSchedule::wants(const Frame& frame, const VoxelMap& map) {
  const std::int64_t since = frames_++ - last_;
  const bool moved = motion_.wants(frame);
  motion_.add(frame.world_from_camera);
  if (!any_) return true;
  if (config_.rule == MaskRule::kInterval) return since >= config_.interval;
  return since >= config_.min_gap &&
         (moved || unexplained_share(map, frame) > config_.unexplained_share);
}

void MaskSchedule::chosen() {
  last_ = frames_ - 1;
  any_ = true;
  motion_.masked();
}

void MaskSchedule::went_without() {
  if (config_.rule == MaskRule::kNeed) any_ = false;
}

float unexplained_share(const VoxelMap& map, const Frame& frame) {
  constexpr int kStep = 8;
  VoxelFinder finder(map);
  const Eigen::Isometry3f world_from_camera = frame.world_from_camera.cast<float>();
  int valid = 0, unexplained = 0;
  for (int y = kStep / 2; y < frame.depth.height(); y += kStep) {
    for (int x = kStep / 2; x < frame.depth.width(); x += kStep) {
      const float z = frame.depth.at(x, y);
      if (z <= 0.f) continue;
      ++valid;
      const Eigen::Vector3f point =
          world_from_camera *
          frame.depth_camera.unproject(static_cast<float>(x), static_cast<float>(y), z);
      unexplained += !finder.seek(point) ||
                     voxel_label(finder.block(), finder.voxel(), map.labels()) == kNoLabel;
    }
  }
  return valid == 0 ? 0.f : static_cast<float>(unexplained) / static_cast<float>(valid);
}

}  // namespace ovimap
