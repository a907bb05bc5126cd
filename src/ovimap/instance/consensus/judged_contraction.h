// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <span>

#include "ovimap/instance/consensus/pair_judge.h"

namespace ovimap {

/// Tells clusters apart while they are contracted.
class PairJudge {
 public:
  virtual ~PairJudge() = default;
  /// The logarithm of the odds that the clusters with these oldest roots are one thing.
  virtual float log_odds(const PairFeatures& features, Label a, Label b) = 0;
  /// `young` went into the cluster of `old`.
  virtual void united(Label old, Label young) { (void)old, (void)young; }
};

/// Clusters of these roots (ascending, with sightings): the two that are most surely one thing
/// become one, and what is around them is judged anew, until no two are more likely one than not
/// (agglomeration by a learned judge, as in connectomics: Nunez-Iglesias et al., PLOS ONE 2013).
/// Judged are clusters that touch and those that some entity shows together. `shapes`: of the map's
/// surface by now. Of super-points without any, which left, masks alone tell: a frame that keeps
/// two apart weighs `apart_weight` against one that joins them. So do masks alone where their
/// source does not rate them, as true ones, and three frames or more say the same and none
/// otherwise: the judge has learned from rendered rooms, and would part a bed from a headboard of
/// another make. `masked`: entities are masks, not regions of depth, which are parts of things.
/// Returns the oldest (lowest) root of each one's cluster.
std::map<Label, Label> contract_by_judge(std::span<const Label> roots,
                                         const EntitySightings& sightings, bool masked,
                                         const SuperPointShapes& shapes, double apart_weight,
                                         PairJudge& judge);

/// The same by the network that comes with the program.
std::map<Label, Label> contract_by_judge(std::span<const Label> roots,
                                         const EntitySightings& sightings, bool masked,
                                         const SuperPointShapes& shapes, double apart_weight);

}  // namespace ovimap
