// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "ovimap/map/voxels/voxel_block.h"

namespace ovimap {

/// Which labels have been merged into which. Voxels keep the labels they were given; reading
/// resolves them here, so that a merge never scans the map (method section 6). Roots are looked up
/// in one step.
class LabelForest {
 public:
  /// A label never used before: 1, 2, ...
  Label create();

  /// Merges two labels; the lower root survives and is returned.
  Label merge(Label a, Label b);

  Label root(Label label) const { return label < root_.size() ? root_[label] : label; }
  Label last_label() const { return static_cast<Label>(root_.size() - 1); }

  /// Counts merges: a block that has seen this epoch needs no resolving.
  std::uint32_t epoch() const { return epoch_; }

  /// Roots by label, index 0 included; for saving.
  const std::vector<Label>& roots() const { return root_; }
  static LabelForest from_roots(std::vector<Label> roots, std::uint32_t epoch);

 private:
  std::vector<Label> root_{kNoLabel};
  std::uint32_t epoch_ = 0;
};

}  // namespace ovimap
