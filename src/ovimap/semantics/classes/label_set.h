// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "ovimap/semantics/query/query_matcher.h"

namespace ovimap {

struct ClassLabel {
  int id = 0;  ///< as the data set numbers it; the line's number in a user's file
  std::string name;
};

/// A closed list of class names.
struct LabelSet {
  std::string name;
  std::vector<ClassLabel> labels;
  bool built_in = false;  ///< a data set's own; a file may bear its name and hold something else
};

/// The sets that are built in: "replica51", "scannet200", "scannet20".
std::vector<std::string> label_set_names();

/// The built-in set of that name, or a text file with one name a line (blank lines and those that
/// begin with # are left out; ids count the names from 1). Throws Error for what is neither, and
/// for a file without names.
LabelSet read_label_set(const std::string& name_or_file);

/// The names' embeddings, one row each, as project_classes compares objects with.
Embeddings encode_labels(ImageTextEncoder& encoder, const LabelSet& set,
                         const std::string& prompts = {});

struct ClassGuess {
  std::size_t label = 0;  ///< position in the set
  float score = 0;        ///< cosine, or standard score
};

/// The `top` classes nearest to each object, best first (method section 11: class projection);
/// an empty list for an object without embedding. `prompts` as in QueryConfig; empty: the
/// encoder's own. Throws Error when the map has no embeddings, or not that encoder's.
std::vector<std::vector<ClassGuess>> project_classes(const SearchIndex& index,
                                                     ImageTextEncoder& encoder, const LabelSet& set,
                                                     std::size_t top,
                                                     const std::string& prompts = {});

/// The same by all evidence that queries go by, the objects' sizes included; the scores are
/// standard ones.
std::vector<std::vector<ClassGuess>> project_classes(const SearchIndex& index,
                                                     const TextMatcher& matcher,
                                                     const LabelSet& set, std::size_t top);

}  // namespace ovimap
