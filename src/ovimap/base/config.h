// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ovimap/base/error.h"

namespace ovimap {

/// One setting of a component: its dotted name, how to read and write it as text, what it accepts.
struct ConfigField {
  std::string name;
  std::string help;     ///< one line, with the unit
  std::string accepts;  ///< "0.001 to 1", "true or false", "superpoints or entity_votes"
  std::function<std::string()> get;
  std::function<void(std::string_view)> set;  ///< throws Error when the text is not accepted
};

/// The list of all fields of a config, gathered by each component's `list_fields(config, fields)`.
/// It is the one description from which parsing, range checks, `--set`, dumps and the generated
/// reference page come. The config must outlive the list.
class ConfigFields {
 public:
  void add(std::string name, int& value, int min, int max, std::string help);
  void add(std::string name, float& value, float min, float max, std::string help);
  void add(std::string name, bool& value, std::string help);
  void add(std::string name, std::string& value, std::string help);

  /// An enumeration, written as one of the given words.
  template <class Enum>
  void add_choice(std::string name, Enum& value, std::vector<std::pair<std::string, Enum>> choices,
                  std::string help);

  /// Everything that `fill` adds gets `prefix.` before its name.
  void group(const std::string& prefix, const std::function<void(ConfigFields&)>& fill);

  /// Sets the field of that dotted name. Throws Error for an unknown name (with the nearest known
  /// one), unreadable text or a value out of range.
  void set(std::string_view name, std::string_view text);

  /// All fields as "name: value" lines in the order they were added: valid YAML.
  std::string dump() const;

  const std::vector<ConfigField>& fields() const { return fields_; }

 private:
  void add_words(std::string name, std::vector<std::string> words, std::function<std::string()> get,
                 std::function<void(std::size_t)> set_index, std::string help);

  std::string prefix_;
  std::vector<ConfigField> fields_;
};

/// The candidate with the smallest edit distance to `word`; empty when there are none.
std::string nearest_word(std::string_view word, const std::vector<std::string>& candidates);

template <class Enum>
void ConfigFields::add_choice(std::string name, Enum& value,
                              std::vector<std::pair<std::string, Enum>> choices, std::string help) {
  std::vector<std::string> words;
  for (const auto& choice : choices) words.push_back(choice.first);
  auto get = [&value, choices] {
    for (const auto& [word, choice] : choices)
      if (choice == value) return word;
    return std::string();
  };
  auto set_index = [&value, choices](std::size_t index) { value = choices[index].second; };
  add_words(std::move(name), std::move(words), get, set_index, std::move(help));
}

}  // namespace ovimap
