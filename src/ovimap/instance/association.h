// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "ovimap/map/voxels/voxel_map.h"
#include "ovimap/segment/mask_fusion.h"

namespace ovimap {

enum class AssociationRule {
  kOneToOne,  ///< greedy; a label serves one segment a frame (the released code)
  kArgmax,    ///< every segment takes its most voted label (the paper's text)
  kMixed,     ///< one to one, but segments of one entity, or of none, may share a label: masks
              ///< tell things apart, depth breaks them into pieces (docs/experiments.md)
};

struct AssociationConfig {
  AssociationRule association = AssociationRule::kMixed;
  int assoc_min_votes = 20;       ///< a label needs more votes than this (theta_assoc)
  float assoc_min_share = 0.05f;  ///< ... and than this share of the segment's points: noise puts a
                                  ///< few points of a wall onto what stands before it
  int merge_min_points = 1000;    ///< larger segments tell which super-points belong together
  float merge_min_share = 0.15f;  ///< ... namely those holding more than this share of its points
};
void list_fields(AssociationConfig& config, ConfigFields& fields);

/// So many points of a segment lie on the surface of a super-point.
struct ShownLabel {
  Label label = kNoLabel;
  int points = 0;
  bool operator==(const ShownLabel&) const = default;
};

struct SegmentAssociation {
  Label label = kNoLabel;  ///< the super-point the segment is fused into
  bool founded = false;    ///< the label is new
  std::vector<Label>
      overlapped;  ///< two or more labels when the segment says they are one (Spa), ascending
  /// The super-points whose surface it shows, ascending: its own, with all points of the segment,
  /// and others with as many points as would make them its own, were the mask a true one.
  std::vector<ShownLabel> shown = {};
};

/// Gives every segment a super-point by spatial voting (paper section 3.1, equation for Omega;
/// method section 4): each point votes for the label of the surface voxel it falls in.
///
/// `surface`: surface_voxels of the frame's depth. Segments without a label found new ones, in the
/// order of their ids. Result by segment, [id - 1].
std::vector<SegmentAssociation> associate(const Segments& segments, const Image<VoxelRef>& surface,
                                          VoxelMap& map, const AssociationConfig& config);

}  // namespace ovimap
