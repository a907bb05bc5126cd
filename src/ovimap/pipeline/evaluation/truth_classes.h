// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "ovimap/semantics/classes/label_set.h"

namespace ovimap {

/// The classes of one truth, as its files give them.
struct TruthClasses {
  std::filesystem::path source;               ///< for messages
  std::vector<std::int32_t> ids;              ///< per vertex; 0 or less = unlabelled
  std::map<std::int32_t, std::string> names;  ///< of the ids; may be empty
};

/// All class names of the truths as one set "truth", each name once, in alphabetical order. Throws
/// Error naming a truth without names.
LabelSet label_set_of(const std::vector<TruthClasses>& truths);

/// A truth's classes in the numbers of an evaluation.
struct NumberedClasses {
  std::vector<std::int32_t> numbers;  ///< per vertex: 1 + position in the set; 0 = void
  std::vector<std::string> unknown;   ///< names that occur and that the set has no class for
  double unknown_share = 0;           ///< of the labelled vertices that have those
};

/// Looks each class up by its name (find_class); without names an id is the set's own. Throws Error
/// for an id that is neither named nor the set's, and when nothing in the truth has a class of the
/// set.
NumberedClasses number_classes(const TruthClasses& truth, const LabelSet& set);

}  // namespace ovimap
