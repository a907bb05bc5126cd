// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace ovimap {

/// Some of a map's blocks: of those that were there when the choice began, the ones that were
/// added, and all that were created since.
class BlockChoice {
 public:
  /// `blocks`: how many the map has (VoxelMap::block_count).
  explicit BlockChoice(std::size_t blocks) : chosen_(blocks, 0) {}

  void add(std::uint32_t slot) {
    if (slot < chosen_.size()) chosen_[slot] = 1;
  }
  bool contains(std::uint32_t slot) const { return slot >= chosen_.size() || chosen_[slot] != 0; }
  /// How many of those that were there when the choice began.
  std::size_t count() const {
    return static_cast<std::size_t>(std::count(chosen_.begin(), chosen_.end(), 1));
  }

 private:
  std::vector<std::uint8_t> chosen_;  ///< by slot
};

}  // namespace ovimap
