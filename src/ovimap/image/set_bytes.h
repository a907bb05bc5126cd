// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>

namespace ovimap {

/// Calls `visit(i)` for each of `count` bytes that is not 0, in order; fast where few are.
template <class Visit>
void for_each_set(const std::uint8_t* bytes, int count, const Visit& visit) {
  int i = 0;
  for (std::uint64_t eight; i + 8 <= count; i += 8) {
    std::memcpy(&eight, bytes + i, sizeof(eight));
    if (eight == 0) continue;
    for (int k = i; k < i + 8; ++k)
      if (bytes[k]) visit(k);
  }
  for (; i < count; ++i)
    if (bytes[i]) visit(i);
}

}  // namespace ovimap
