// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/words/main_colors.h"

#include <algorithm>

namespace ovimap {

std::vector<std::pair<Color, float>> main_colors(const ColorShares& shares) {
  constexpr float kLeastShare = 0.1f;
  std::vector<std::pair<Color, float>> colors;
  for (std::size_t i = 0; i < shares.size(); ++i)
    if (shares[i] >= kLeastShare) colors.emplace_back(static_cast<Color>(i), shares[i]);
  std::stable_sort(colors.begin(), colors.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  return colors;
}

}  // namespace ovimap
