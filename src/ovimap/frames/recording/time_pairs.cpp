// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/recording/time_pairs.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace ovimap {

std::vector<std::pair<std::size_t, std::size_t>> pairs_by_time(const std::vector<double>& a,
                                                               const std::vector<double>& b,
                                                               double max_gap_s) {
  std::vector<std::tuple<double, std::size_t, std::size_t>> candidates;
  std::size_t first = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    while (first < b.size() && b[first] < a[i] - max_gap_s) ++first;
    for (std::size_t j = first; j < b.size() && b[j] <= a[i] + max_gap_s; ++j)
      candidates.emplace_back(std::abs(b[j] - a[i]), i, j);
  }
  std::sort(candidates.begin(), candidates.end());
  std::vector<char> a_used(a.size()), b_used(b.size());
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (const auto& [gap_s, i, j] : candidates) {
    if (a_used[i] || b_used[j]) continue;
    a_used[i] = b_used[j] = 1;
    pairs.emplace_back(i, j);
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace ovimap
