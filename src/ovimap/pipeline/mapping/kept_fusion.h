// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/io/map_tables/map_document.h"
#include "ovimap/pipeline/mapping/mapper_config.h"

namespace ovimap {

/// Fuses kept frames again, one after another, from poses that may be others than before.
class KeptFusion {
 public:
  /// `config`: the settings of the run that kept them; it must stay. `camera`: of their depth.
  KeptFusion(const MapperConfig& config, const PinholeCamera& camera)
      : config_(config), camera_(camera) {}

  /// Adds geometry, colour and the labels that the frame was given, as far as they were merged by
  /// now. Throws Error with a phrase where the frame is damaged.
  void fuse(const KeptFrame& kept, const Pose& world_from_camera, VoxelMap& map);

  /// Which of the frames so far were looks of their own.
  const SeparateLooks& looks() const { return looks_; }

 private:
  const MapperConfig& config_;
  PinholeCamera camera_;
  SeparateLooks looks_;
};

}  // namespace ovimap
