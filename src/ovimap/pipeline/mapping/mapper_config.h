// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "ovimap/base/config.h"
#include "ovimap/instance/association.h"
#include "ovimap/instance/instance_registry.h"
#include "ovimap/instance/instance_summary.h"
#include "ovimap/map/fusion/free_space.h"
#include "ovimap/map/voxels/voxel_map.h"
#include "ovimap/pipeline/mapping/appearance_builder.h"
#include "ovimap/pipeline/mapping/frame_store.h"
#include "ovimap/pipeline/motion/motion_config.h"
#include "ovimap/segment/depth_estimate.h"
#include "ovimap/segment/depth_segmentation.h"
#include "ovimap/segment/mask_fusion.h"

namespace ovimap {

/// Every parameter of the mapper, each defined beside its component.
struct MapperConfig {
  SegmentDepthConfig segment;
  DepthEstimateConfig depth;
  MaskFusionConfig mask_fusion;
  AssociationConfig association;
  InstanceConfig instance;
  InstanceSummaryConfig summary;
  VoxelMapConfig map;
  FreeSpaceConfig free_space;
  MotionConfig motion;
  SemanticsConfig semantics;
  FrameStoreConfig frame_store;
  int view_interval = 0;  ///< objects are looked at in every n-th frame; 0: in every frame with an
                          ///< encoder, in every stored_view_interval-th without
  int stored_view_interval = 5;  ///< what view_interval 0 means when crops are only kept
  int mask_interval = 0;     ///< 2D masks are asked for every n-th frame, the frames between add
                             ///< geometry and colour; 0: by mask_motion where the source is slow (a
                             ///< network), every frame otherwise
  float mask_motion = 0.1f;  ///< what moves by less of the picture's width since the last masks
                             ///< needs no new ones (MaskMotion); 0: every frame
  float occlusion_margin_m =
      0.05f;  ///< how much nearer a surface must be to hide a point from the colour camera
  bool allow_still_camera = false;  ///< a recording in which every pose is the same is no mistake
  float max_range_m = 10.f;         ///< how far the map is projected back
};
void list_fields(MapperConfig& config, ConfigFields& fields);

/// "default", or "reference": thresholds, rules, views and crops as the paper's released code has
/// them (docs/reference-preset.md). Throws Error for another name.
MapperConfig mapper_preset(const std::string& name);

/// The settings that a map was made with, as far as this program knows them
/// (MapRecord::config_text).
MapperConfig config_of_map(const std::string& config_text);

}  // namespace ovimap
