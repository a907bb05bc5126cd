// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <utility>

#include "ovimap/map/label_forest.h"

namespace ovimap {

/// Evidence that two super-points are one thing, and that they are two: in frames.
struct PairCount {
  int joined = 0, apart = 0;
  bool operator==(const PairCount&) const = default;
};

using PairCounts = std::map<std::pair<Label, Label>, PairCount>;  ///< by (lower, higher) root

/// Counts of the dropped label go to the kept one. Combined by maximum: the two histories overlap
/// in time.
void merge_labels(PairCounts& counts, Label keep, Label drop);

}  // namespace ovimap
