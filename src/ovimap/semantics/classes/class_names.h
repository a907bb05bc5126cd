// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "ovimap/semantics/classes/label_set.h"

namespace ovimap {

/// Position in the set of the class that a truth calls `name`: the one of that name (blanks,
/// hyphens and underscores are alike), else, for the built-in sets, the one that the table of our
/// rendered rooms gives (data/room_classes.txt). nullopt: the set has no class for it.
std::optional<std::size_t> find_class(const LabelSet& set, const std::string& name);

/// A part of a set whose figures are also given alone.
struct LabelGroup {
  std::string name;
  std::vector<std::size_t> labels;  ///< positions in the set
};

/// Head, common and tail of scannet200 (its benchmark's lists) and replica51 (thirds by frequency,
/// as OpenNeRF cuts them); none for other sets.
std::vector<LabelGroup> label_groups(const LabelSet& set);

/// Positions of the classes whose instances the data set's benchmark does not score: wall, floor
/// and, except in ScanNet, ceiling.
std::vector<std::size_t> stuff_labels(const LabelSet& set);

}  // namespace ovimap
