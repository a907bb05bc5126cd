// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "ovimap/instance/pair_counts.h"

namespace ovimap {

class ConfigFields;

struct ConsensusConfig {
  float apart_weight = 0.5f;  ///< what a frame that keeps two super-points apart weighs against one
                              ///< that joins them; networks cut objects up more often than they
                              ///< join them
};
void list_fields(ConsensusConfig& config, ConfigFields& fields);

/// Which super-points are one object, by what the 2D entities of all frames say together.
///
/// A frame joins two super-points when one entity shows both, and keeps them apart when different
/// entities do. Objects are the clusters of greedy additive edge contraction (Keuper et al., ICCV
/// 2015) over joined - apart_weight * apart: the pair most clearly one is contracted first, its
/// edges are added up, until no edge speaks for joining. Unlike votes that are cast frame by frame,
/// the result does not depend on the order of the frames, and a mask that once spans two objects
/// does no lasting harm.
class EntityConsensus {
 public:
  struct Sighting {
    Label root = kNoLabel;
    std::uint16_t entity = 0;  ///< not 0
  };

  explicit EntityConsensus(const ConsensusConfig& config = {}) : config_(config) {}

  /// Adds one frame: each root at most once, ascending.
  void observe(std::span<const Sighting> sightings);

  /// Two super-points became one.
  void merge(Label keep, Label drop) { merge_labels(pairs_, keep, drop); }

  /// The oldest (lowest) root of each root's object; a root that never met another is absent.
  std::map<Label, Label> objects() const;

  const PairCounts& pairs() const { return pairs_; }
  void restore(PairCounts pairs) { pairs_ = std::move(pairs); }

 private:
  ConsensusConfig config_;
  PairCounts pairs_;
};

}  // namespace ovimap
