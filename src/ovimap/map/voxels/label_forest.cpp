// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/map/voxels/label_forest.h"

#include <algorithm>

#include "ovimap/base/error.h"

namespace ovimap {

Label LabelForest::create() {
  root_.push_back(static_cast<Label>(root_.size()));
  return root_.back();
}

Label LabelForest::merge(Label a, Label b) {
  const Label keep = std::min(root(a), root(b)), drop = std::max(root(a), root(b));
  OVIMAP_ASSERT(keep != kNoLabel);
  if (keep == drop) return keep;
  // Merges are rare and labels few (one word each), so every chain is kept one step long.
  std::replace(root_.begin(), root_.end(), drop, keep);
  ++epoch_;
  return keep;
}

LabelForest LabelForest::from_roots(std::vector<Label> roots, std::uint32_t epoch) {
  bool consistent = !roots.empty() && roots[0] == kNoLabel;
  for (std::size_t label = 1; consistent && label < roots.size(); ++label)
    consistent = roots[label] >= 1 && roots[label] <= label && roots[roots[label]] == roots[label];
  if (!consistent)
    throw Error("the table of merged labels is corrupt; restore the map from a copy");
  LabelForest forest;
  forest.root_ = std::move(roots);
  forest.epoch_ = epoch;
  return forest;
}

}  // namespace ovimap
