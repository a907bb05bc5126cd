// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "ovimap/io/map_tables/map_document.h"

namespace ovimap {

class ConfigFields;

struct ObjectLayoutConfig {
  float min_likeness = 0.3f;  ///< of size, for two objects that may be the same
  int max_partners = 8;       ///< objects of the first map that one of the second may be
  float nearest_m = 0.5f;     ///< two objects nearer to each other say too little of a turn
  float slack_m = 0.25f;      ///< by which distances may differ: maps see parts of an object
  int max_proposals = 48;
};
void list_fields(ObjectLayoutConfig& config, ConfigFields& fields);

/// An object as a landmark.
struct Landmark {
  Eigen::Vector3d at = Eigen::Vector3d::Zero();       ///< its middle in the ground frame, metres
  Eigen::Vector3f sizes_m = Eigen::Vector3f::Zero();  ///< long side, short side, height
  Eigen::VectorXf look;                               ///< fused embedding; empty: none
};

/// Where a map's objects stand to each other.
struct ObjectLayout {
  Pose ground_from_world = Pose::Identity();  ///< z is up
  std::vector<Landmark> landmarks;
  EncoderIdentity encoder;
};
ObjectLayout layout_of(const MapRecord& map);

/// A pose that objects speak for.
struct LayoutProposal {
  Pose a_from_b = Pose::Identity();
  double votes = 0;  ///< sum of the likenesses of objects that it brings together
  int objects = 0;   ///< how many these are
};

/// How two layouts may lie to each other. Objects that are alike (in size, and in looks where both
/// have embeddings of one encoder) propose poses by twos where their distance and heights fit:
/// upright ones alone, since both layouts know what is up. Each proposal is fitted to all objects
/// that it brings together; those that most speak for come first, no two alike.
std::vector<LayoutProposal> propose_poses(const ObjectLayout& a, const ObjectLayout& b,
                                          const ObjectLayoutConfig& config = {});

/// Cosine of two objects' embeddings; none when one has none, or they are of different encoders.
std::optional<float> look_similarity(const MapRecord& a, InstanceId id_a, const MapRecord& b,
                                     InstanceId id_b);

/// In [0, 1]: how alike two boxes are in size, whatever way they stand: the smallest ratio of their
/// sorted sides.
float size_similarity(const InstanceSummary& a, const InstanceSummary& b);

}  // namespace ovimap
