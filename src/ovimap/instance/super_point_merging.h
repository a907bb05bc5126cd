// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <span>
#include <utility>
#include <vector>

#include "ovimap/instance/association.h"

namespace ovimap {

struct MergeConfig {
  int merge_min_count = 10;       ///< merge when Spa exceeds this (theta_merge)
  float merge_max_dissent = 1.f;  ///< ... and is not outweighed: frames that keep the two apart,
                                  ///< per frame that joins them
};
void list_fields(MergeConfig& config, ConfigFields& fields);

/// Counts how often segments span two super-points and says when to merge them (paper, supplement:
/// Spa(a, b) > theta_merge; method section 6).
///
/// Beyond the paper, frames that show both super-points as different segments count against the
/// merge: a magazine that the mask of its table swallows in some frames stays a magazine. A
/// consensus of entities (EntityConsensus) merges nothing.
class SuperPointMerging {
 public:
  struct Merge {
    Label keep, drop;
  };

  explicit SuperPointMerging(const MergeConfig& config = {}) : config_(config) {}

  /// Adds one frame. Returns the merges it brings about, already made in `forest`, in order.
  std::vector<Merge> observe(std::span<const SegmentAssociation> associations, LabelForest& forest);

  struct PairCount {
    int joined = 0, apart = 0;
    bool operator==(const PairCount&) const = default;
  };
  using PairCounts = std::map<std::pair<Label, Label>, PairCount>;
  const PairCounts& counts() const { return counts_; }
  void restore(PairCounts counts) { counts_ = std::move(counts); }

 private:
  void count_joined(std::span<const SegmentAssociation> associations);
  void count_apart(std::span<const SegmentAssociation> associations);
  bool ripe(const PairCount& count) const;
  void rename(Label keep, Label drop);

  MergeConfig config_;
  PairCounts counts_;  ///< by (lower, higher) root
};

}  // namespace ovimap
