// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "ovimap/pipeline/alignment/object_layout.h"
#include "ovimap/pipeline/alignment/place_agreement.h"

namespace ovimap {

struct AlignmentConfig {
  float min_overlap = 0.15f;    ///< of what the cameras of one map saw that must be in the other
  float min_fit = 0.9f;         ///< of surface where both looked that must agree
  float min_clear_fit = 0.85f;  ///< the same where the next answer is not half as good
  float min_lead = 0.08f;       ///< by which the best answer must beat the next other one
  int min_objects = 6;          ///< that must speak for it: two propose, every corner has a floor
                                ///< and two walls, and one more must agree
  float spacing_m = 0.06f;      ///< between surface points that are fitted to each other
  ObjectLayoutConfig layout;
  PlaceConfig place;
};
void list_fields(AlignmentConfig& config, ConfigFields& fields);

/// How one map lies in the frame of another.
struct MapAlignment {
  Pose a_from_b = Pose::Identity();
  float overlap = 0;  ///< of what the cameras of one map saw, the share that the other map has: of
                      ///< the map that has the larger share
  float fit = 0;      ///< of upright surface where both maps looked, the share that agrees
  float runner_up = 0;  ///< score of the best other answer
  int objects = 0;      ///< that proposed it; 0: it was given
  /// What meets, less as much of it as is contradicted: half of a fit is what chance gives.
  float score() const { return overlap * std::max(0.f, 2 * fit - 1); }
};

/// How well two maps agree in a given pose.
MapAlignment judge_alignment(const MapDocument& a, const MapDocument& b, const Pose& a_from_b,
                             const AlignmentConfig& config = {});

/// All answers that were looked at, the best first: poses that objects propose (propose_poses),
/// fitted surface to surface and held against what the cameras of both maps saw (agreement).
std::vector<MapAlignment> alignments(const MapDocument& a, const MapDocument& b,
                                     const AlignmentConfig& config = {});

/// The best of them, and what speaks against believing it, with the figures; empty when nothing
/// does.
struct AlignmentSearch {
  MapAlignment best;
  std::string doubt;
};

/// Looks for how two maps of one place lie to each other.
AlignmentSearch search_alignment(const MapDocument& a, const MapDocument& b,
                                 const AlignmentConfig& config = {});

/// The same. Throws Error when the answer is not to be believed.
MapAlignment align_maps(const MapDocument& a, const MapDocument& b,
                        const AlignmentConfig& config = {});

}  // namespace ovimap
