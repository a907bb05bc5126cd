// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace ovimap {

/// Which images of two cameras were taken together: pairs (of `a`, of `b`) at most `max_gap_s`
/// apart, the closest first, each image used once; in order of time. Both in order of time,
/// seconds.
std::vector<std::pair<std::size_t, std::size_t>> pairs_by_time(const std::vector<double>& a,
                                                               const std::vector<double>& b,
                                                               double max_gap_s);

}  // namespace ovimap
