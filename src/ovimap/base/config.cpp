// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/base/config.h"

#include <algorithm>
#include <charconv>

#include "ovimap/base/edit_distance.h"

namespace ovimap {

namespace {

template <class Number>
std::string to_text(Number value) {
  char buffer[48];
  const auto result = std::to_chars(buffer, buffer + sizeof(buffer), value);
  return std::string(buffer, result.ptr);
}

template <class Number>
Number parse_number(const std::string& name, std::string_view text, Number min, Number max) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool readable = error == std::errc() && end == text.data() + text.size();
  if (!readable || !(value >= min && value <= max))
    throw Error(
        concat("setting ", name, " is '", text, "'; accepted is a number from ", min, " to ", max));
  return value;
}

}  // namespace

std::string nearest_word(std::string_view word, const std::vector<std::string>& candidates) {
  const auto best = std::min_element(candidates.begin(), candidates.end(),
                                     [word](const std::string& a, const std::string& b) {
                                       return edit_distance(word, a) < edit_distance(word, b);
                                     });
  return best == candidates.end() ? std::string() : *best;
}

void ConfigFields::add(std::string name, int& value, int min, int max, std::string help) {
  const std::string full = prefix_ + name;
  fields_.push_back({full, std::move(help), concat(min, " to ", max),
                     [&value] { return to_text(value); },
                     [&value, full, min, max](std::string_view text) {
                       value = parse_number<int>(full, text, min, max);
                     }});
}

void ConfigFields::add(std::string name, float& value, float min, float max, std::string help) {
  const std::string full = prefix_ + name;
  fields_.push_back({full, std::move(help), concat(min, " to ", max),
                     [&value] { return to_text(value); },
                     [&value, full, min, max](std::string_view text) {
                       value = parse_number<float>(full, text, min, max);
                     }});
}

void ConfigFields::add(std::string name, bool& value, std::string help) {
  add_words(
      std::move(name), {"false", "true"}, [&value] { return value ? "true" : "false"; },
      [&value](std::size_t index) { value = index == 1; }, std::move(help));
}

void ConfigFields::add(std::string name, std::string& value, std::string help) {
  fields_.push_back({prefix_ + name, std::move(help), "text", [&value] { return value; },
                     [&value](std::string_view text) { value = std::string(text); }});
}

void ConfigFields::add_words(std::string name, std::vector<std::string> words,
                             std::function<std::string()> get,
                             std::function<void(std::size_t)> set_index, std::string help) {
  const std::string full = prefix_ + name;
  std::string accepts;
  for (const std::string& word : words) accepts += (accepts.empty() ? "" : " or ") + word;
  fields_.push_back({full, std::move(help), accepts, std::move(get),
                     [full, words, accepts, set_index](std::string_view text) {
                       const auto found = std::find(words.begin(), words.end(), text);
                       if (found == words.end())
                         throw Error(
                             concat("setting ", full, " is '", text, "'; accepted is ", accepts));
                       set_index(static_cast<std::size_t>(found - words.begin()));
                     }});
}

void ConfigFields::group(const std::string& prefix,
                         const std::function<void(ConfigFields&)>& fill) {
  const std::string outer = prefix_;
  prefix_ += prefix + ".";
  fill(*this);
  prefix_ = outer;
}

void ConfigFields::set(std::string_view name, std::string_view text) {
  for (const ConfigField& field : fields_)
    if (field.name == name) return field.set(text);
  std::vector<std::string> names, containing;
  for (const ConfigField& field : fields_) {
    names.push_back(field.name);
    if (field.name.find(name) != std::string::npos) containing.push_back(field.name);
  }
  throw Error(concat("there is no setting '", name, "'; did you mean '",
                     nearest_word(name, containing.empty() ? names : containing), "'?"));
}

std::string ConfigFields::dump() const {
  std::string text;
  for (const ConfigField& field : fields_) text += field.name + ": " + field.get() + "\n";
  return text;
}

}  // namespace ovimap
