// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace ovimap {

/// Image rows that one task of a parallel loop takes where pixels are worked on by themselves.
inline constexpr std::size_t kPixelRowsPerTask = 32;
/// ... and where each task sums up the rows of a window's radius around its own as well: the
/// taller, the less of that.
inline constexpr std::size_t kWindowRowsPerTask = 60;

}  // namespace ovimap
