// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/instance/pair_counts.h"

#include <algorithm>
#include <vector>

namespace ovimap {

void merge_labels(PairCounts& counts, Label keep, Label drop) {
  std::vector<PairCounts::value_type> moved;
  for (auto found = counts.begin(); found != counts.end();) {
    const auto [a, b] = found->first;
    if (a != drop && b != drop) {
      ++found;
      continue;
    }
    moved.emplace_back(*found);
    found = counts.erase(found);
  }
  for (const auto& [pair, count] : moved) {
    const Label other = pair.first == drop ? pair.second : pair.first;
    if (other == keep) continue;
    PairCount& into = counts[{std::min(keep, other), std::max(keep, other)}];
    into.joined = std::max(into.joined, count.joined);
    into.apart = std::max(into.apart, count.apart);
  }
}

}  // namespace ovimap
