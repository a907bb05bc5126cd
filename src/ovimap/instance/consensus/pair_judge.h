// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ovimap/instance/consensus/edge_contraction.h"
#include "ovimap/instance/consensus/super_point_shapes.h"

namespace ovimap {

/// So much of a cluster of super-points was seen in an entity.
struct EntityShare {
  EntitySighting sighting;
  std::int64_t vertices = 0;         ///< of the super-points seen in it
  std::int64_t entity_vertices = 0;  ///< of all super-points seen in it, of other clusters too
};

/// Super-points that are taken for one thing: what masks and what the surface say of them together.
struct PointCluster {
  std::vector<EntityShare> shares;  ///< by sighting
  SuperPointShape shape;
  bool rated = false;  ///< the source of some mask says how good it is
};
PointCluster united(const PointCluster& a, const PointCluster& b);

/// What tells whether two clusters are one thing. The smaller one is named first.
enum class PairFeature {
  kJoined,       ///< log(1 + frames in which one entity shows both)
  kApart,        ///< log(1 + frames in which different entities do)
  kJoinedShare,  ///< the former's share of both
  kSmallSize,    ///< log of its vertices
  kLargeSize,
  kContact,    ///< log(1 + edges between them, in roots of the smaller one's vertices)
  kTouching,   ///< 1 where there are any
  kFold,       ///< mean change of the normal across the border, positive where convex
  kStep,       ///< mean change of colour across the border
  kColor,      ///< difference of their mean colours
  kTone,       ///< the same of red against blue, which light changes less
  kAlign,      ///< product of their mean normals
  kSmallFlat,  ///< length of its mean normal: 1 where it is plane
  kLargeFlat,
  kSmallOffset,  ///< of the large one's middle from the small one's plane, metres
  kLargeOffset,
  kGap,          ///< between their boxes, metres
  kLargerBox,    ///< log of the common box's volume over that of the larger box
  kBothBoxes,    ///< log of the common box's volume over that of both
  kLargeVolume,  ///< log of the larger one's box's volume
  kFitBoth,      ///< mean over the frames that show both of the best overlap of an entity with both
                 ///< together (intersection over union),
  kFitSmall,     ///< ... with the small one alone,
  kFitLarge,     ///< ... with the large one alone
  kAgreement,    ///< how well the map's masks agree with each other: 1 where they never differ
  kCount
};
using PairFeatures = std::array<float, static_cast<std::size_t>(PairFeature::kCount)>;

/// What the frames that show two clusters say of them.
struct Meetings {
  double joined = 0, apart = 0;  ///< frames, by the share of each that they show in entities
  double fit_a = 0, fit_b = 0, fit_both = 0;  ///< sums of the best overlap with one entity
};
Meetings meetings_of(const PointCluster& a, const PointCluster& b);

/// `met`: meetings_of(a, b).
PairFeatures pair_features(const PointCluster& a, const PointCluster& b, const Meetings& met,
                           const SuperPointBorder& border, float agreement);

/// How sure it is that two clusters are one thing: the logarithm of the odds, by a small network
/// that was trained on maps of rendered rooms (tools/models/train_pair_judge.py).
float log_odds_of_one(const PairFeatures& features);

}  // namespace ovimap
