// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ovimap/io/map_tables/map_document.h"

namespace ovimap {

class ConfigFields;

struct MapMergeConfig {
  float tolerance_m = 0.03f;     ///< surfaces nearer to each other are at the same place
  float same_iou = 0.25f;        ///< overlap at which two objects are one
  float same_common_iou = 0.5f;  ///< or where both maps have surface, if they share enough of it:
  int common_points = 25;        ///< that many points, 2 cm apart
  float same_share = 0.6f;       ///< or of either one's points, where the looks agree too
  float alike = 0.6f;            ///< cosine at which looks agree
  float unlike = 0.2f;           ///< cosine below which they speak against it
};
void list_fields(MapMergeConfig& config, ConfigFields& fields);

/// Two objects that were taken for one.
struct MergedPair {
  InstanceId a = 0, b = 0;  ///< ids in the merged map
  float overlap = 0;        ///< intersection over union of the surfaces
  std::optional<float> cosine;
};

struct MergeConflict {
  InstanceId a = 0, b = 0;  ///< ids in the merged map
  std::string what;         ///< a sentence
};

struct MapMerge {
  MapDocument map;
  std::vector<MergedPair> pairs;
  std::vector<MergeConflict> conflicts;
};

/// One map of two, in the frame of `a`: voxels fused, everything of `b` under new ids (those of `a`
/// stay). Objects that are one are joined by an edit in the merged map's log, which can be undone
/// like a person's; the logs of both maps go on, their histories do not. Both maps as load_map
/// gives them; `b` must have the embeddings of the same encoder, or none. Throws Error otherwise.
MapMerge merge_maps(MapDocument a, const MapDocument& b, const Pose& a_from_b,
                    const MapMergeConfig& config = {});

}  // namespace ovimap
