// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/io/map_tables/map_document.h"
#include "ovimap/pipeline/mapping/frame_store.h"
#include "ovimap/pipeline/mapping/mapper_config.h"

namespace ovimap {

/// A kept frame, ready to be fused.
struct PreparedKept {
  /// Throws Error with a phrase where the frame is damaged. `config`: the settings of the run that
  /// kept it.
  PreparedKept(const KeptFrame& kept, const MapperConfig& config, const PinholeCamera& camera);

  KeptImages images;
  DepthSurface surface;
  DepthEstimate estimate;
};

/// Fuses kept frames again, one after another, from poses that may be others than before.
class KeptFusion {
 public:
  /// `config`: the settings of the run that kept them; it must stay. `camera`: of their depth.
  KeptFusion(const MapperConfig& config, const PinholeCamera& camera)
      : config_(config), camera_(camera) {}

  /// Adds geometry, colour and the labels that the frame was given, as far as they were merged by
  /// now, to `blocks` (null: to all). Returns the slots of the blocks that it visited, in no
  /// particular order. Throws Error with a phrase where the frame is damaged.
  std::vector<std::uint32_t> fuse(const KeptFrame& kept, const Pose& world_from_camera,
                                  VoxelMap& map, const BlockChoice* blocks = nullptr);
  /// Instead of `fuse`, for a frame that has nothing to add.
  void pass(const Pose& world_from_camera) { looks_.next(world_from_camera, config_.free_space); }

  /// Which of the frames so far were looks of their own.
  const SeparateLooks& looks() const { return looks_; }

 private:
  const MapperConfig& config_;
  PinholeCamera camera_;
  SeparateLooks looks_;
};

}  // namespace ovimap
