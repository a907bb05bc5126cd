// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/classes/label_set.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "ovimap/base/error.h"
#include "ovimap/base/parallel.h"
#include "ovimap/semantics/query/query_matcher.h"
#include "ovimap/semantics/query/query_text.h"
#include "ovimap/semantics/words/word_lists.h"

namespace ovimap {

namespace {

constexpr std::size_t kGuessedObjectsPerTask = 256;

/// "93 wall" -> {93, "wall"}
ClassLabel numbered_label(const std::string& entry) {
  ClassLabel label;
  const auto end = std::from_chars(entry.data(), entry.data() + entry.size(), label.id).ptr;
  label.name = std::string(end + 1, entry.data() + entry.size());
  return label;
}

LabelSet labels_of_file(const std::string& file) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  std::ifstream in(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  if (!in) throw Error(concat("class file ", file, " cannot be read; check its permissions"));
  if (text.starts_with(kByteOrderMark)) text.erase(0, kByteOrderMark.size());
  LabelSet set{std::filesystem::path(file).stem().string(), {}};
  for (std::string& entry : list_entries(text))
    set.labels.push_back({static_cast<int>(set.labels.size()) + 1, std::move(entry)});
  if (set.labels.empty())
    throw Error(concat("class file ", file, " names no class; write one name a line"));
  return set;
}

/// Class names of data sets as a person would write them: "tv-screen" -> "tv screen".
std::vector<std::string> spoken_names(const LabelSet& set) {
  std::vector<std::string> names;
  for (const ClassLabel& label : set.labels) {
    names.push_back(label.name);
    std::replace_if(
        names.back().begin(), names.back().end(), [](char c) { return c == '-' || c == '_'; }, ' ');
  }
  return names;
}

std::vector<ClassGuess> best_guesses(const Eigen::VectorXf& cosines, std::size_t top) {
  std::vector<ClassGuess> guesses(static_cast<std::size_t>(cosines.size()));
  for (std::size_t k = 0; k < guesses.size(); ++k)
    guesses[k] = {k, cosines[static_cast<Eigen::Index>(k)]};
  const std::size_t count = std::min(top, guesses.size());
  std::partial_sort(guesses.begin(), guesses.begin() + static_cast<std::ptrdiff_t>(count),
                    guesses.end(), [](const ClassGuess& a, const ClassGuess& b) {
                      return a.score != b.score ? a.score > b.score : a.label < b.label;
                    });
  guesses.resize(count);
  return guesses;
}

}  // namespace

std::vector<std::string> label_set_names() {
  return {"replica51", "scannet200", "scannet20"};
}

LabelSet read_label_set(const std::string& name_or_file) {
  const std::vector<std::string> names = label_set_names();
  if (std::find(names.begin(), names.end(), name_or_file) != names.end()) {
    LabelSet set{name_or_file, {}, true};
    for (const std::string& entry : list_entries(builtin_word_list(name_or_file)))
      set.labels.push_back(numbered_label(entry));
    return set;
  }
  std::error_code unreadable;
  if (std::filesystem::is_regular_file(name_or_file, unreadable))
    return labels_of_file(name_or_file);
  throw Error(
      concat("there is no class set or file '", name_or_file,
             "'; the sets are replica51, scannet200 and scannet20, or name a text file with "
             "one class a line"));
}

Embeddings encode_labels(ImageTextEncoder& encoder, const LabelSet& set,
                         const std::string& prompts) {
  return encode_prompted(encoder, spoken_names(set),
                         split_prompts(prompts.empty() ? encoder.prompt_template() : prompts),
                         TextUse::kVocabulary);
}

std::vector<std::vector<ClassGuess>> project_classes(const SearchIndex& index,
                                                     ImageTextEncoder& encoder, const LabelSet& set,
                                                     std::size_t top, const std::string& prompts) {
  require_embeddings(index);
  require_embedding_length(index, encoder.identity().dimension,
                           "encoder '" + encoder.identity().name + "'");
  const Embeddings classes = encode_labels(encoder, set, prompts);
  std::vector<std::vector<ClassGuess>> guesses(index.size());
  parallel_for(index.size(), kGuessedObjectsPerTask, [&](std::size_t i) {
    if (!index.has_embedding(i)) return;
    const auto row = index.embeddings().row(static_cast<Eigen::Index>(i));
    guesses[i] = best_guesses(classes * row.transpose(), top);
  });
  return guesses;
}

std::vector<std::vector<ClassGuess>> project_classes(const SearchIndex& index,
                                                     const TextMatcher& matcher,
                                                     const LabelSet& set, std::size_t top) {
  const Eigen::MatrixXf fits = matcher.fit_of_each(spoken_names(set));
  std::vector<std::vector<ClassGuess>> guesses(index.size());
  for (std::size_t i = 0; i < index.size(); ++i)
    if (index.has_embedding(i))
      guesses[i] = best_guesses(fits.row(static_cast<Eigen::Index>(i)).transpose(), top);
  return guesses;
}

}  // namespace ovimap
