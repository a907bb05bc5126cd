// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/io/map_tables/map_document.h"
#include "ovimap/map/rays/observed_space.h"

namespace ovimap {

class ConfigFields;

struct AlignmentConfig {
  float min_overlap = 0.15f;    ///< of the second map's surface that must meet that of the first
  float min_fit = 0.9f;         ///< of surface where both looked that must agree
  float min_clear_fit = 0.75f;  ///< the same where the next answer is not half as good: noisy depth
                                ///< alone costs a fifth
  float min_lead = 0.08f;       ///< by which the best answer must beat the next other one
  float min_likeness = 0.35f;   ///< of size, for two objects that may be the same
  int max_partners = 6;         ///< objects of the first map that one of the second may be
  float spacing_m = 0.06f;      ///< between surface points that are fitted to each other
  float tolerance_m = 0.04f;    ///< surfaces nearer to each other agree
  ObservedSpaceConfig space{.width_px = 80, .max_views = 100};
};
void list_fields(AlignmentConfig& config, ConfigFields& fields);

/// How one map lies in the frame of another.
struct MapAlignment {
  Pose a_from_b = Pose::Identity();
  float overlap = 0;    ///< of the smaller map's upright surface, the share at the other's
  float fit = 0;        ///< of upright surface where both maps looked, the share that agrees
  float runner_up = 0;  ///< score of the best other answer, where `score` is overlap * fit
  float score() const { return overlap * fit; }
};

/// How well two maps agree in a given pose.
MapAlignment judge_alignment(const MapDocument& a, const MapDocument& b, const Pose& a_from_b,
                             const AlignmentConfig& config = {});

/// Finds how two maps of one place lie to each other. Objects that are alike (in size, and in looks
/// where both maps have embeddings of one encoder) propose poses by twos, upright ones alone, since
/// both maps know what is up; the best are refined by fitting surface to surface (point-to-plane
/// ICP), and judged by how much surface meets and how little of it lies where the other map saw
/// nothing. Throws Error, with the figures, when no answer is convincing.
MapAlignment align_maps(const MapDocument& a, const MapDocument& b,
                        const AlignmentConfig& config = {});

}  // namespace ovimap
