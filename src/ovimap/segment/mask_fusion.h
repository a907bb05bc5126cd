// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "ovimap/segment/depth_segmentation.h"

namespace ovimap {

struct MaskFusionConfig {
  int min_region_px = 100;  ///< smaller geometric regions take no part
  int min_entity_px = 100;  ///< an entity outside all regions needs this many valid depth pixels
                            ///< (the released code drops all of them)
  float split_entity_share =
      0.9f;  ///< an entity is split off when more than this share of it lies in the region
  float split_region_share = 0.5f;  ///< ... and it covers less than this share of the region
  int split_core_px = 3;  ///< ... or when its part of the region holds a square of this side, so
                          ///< that it is no strip that a mask's uncertain outline left over there
  float adopt_region_share =
      0.2f;  ///< the rest of a region takes an entity that covers at least this share
};
void list_fields(MaskFusionConfig& config, ConfigFields& fields);

struct Segment {
  std::uint16_t entity = 0;  ///< id of the 2D entity it belongs to; 0 = background
  int area_px = 0;
};

/// The pieces of one frame that are lifted to 3D.
struct Segments {
  IdImage ids;                    ///< depth image size; 0 = none
  std::vector<Segment> segments;  ///< segments[id - 1]
  /// How good its source rates the mask of each entity, from 0 to 1: ratings[entity - 1]; empty:
  /// all 1.
  std::vector<float> ratings = {};
};

/// Cuts geometric regions by 2D entities (MaskFusion, paper section 3.1; method section 3).
///
/// `entity_ids`: entity of each depth pixel (already registered to the depth camera; 0 = none),
/// same size as `regions.ids`. The result depends only on the sets of pixels, not on how entities
/// are numbered (two entities that cover exactly as much of a region excepted: the lower id takes
/// the rest).
Segments fuse_masks(const DepthRegions& regions, const IdImage& entity_ids, const DepthImage& depth,
                    const MaskFusionConfig& config);

/// Every region a segment of its own: mapping without 2D masks.
Segments segments_of_regions(const DepthRegions& regions);

}  // namespace ovimap
