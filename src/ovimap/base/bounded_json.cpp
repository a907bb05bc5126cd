// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/base/bounded_json.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "ovimap/base/error.h"

namespace ovimap {

namespace {

using nlohmann::json;

constexpr std::size_t kShownKey = 60;  // characters of a key in a fault

/// Builds the document from the parser's events. nlohmann's own builder knows no depth, and its
/// parser callback searches the whole list again after each entry.
class Builder : public nlohmann::json_sax<json> {
 public:
  bool null() override { return put(nullptr) != nullptr; }
  bool boolean(bool value) override { return put(value) != nullptr; }
  bool number_integer(number_integer_t value) override { return put(value) != nullptr; }
  bool number_unsigned(number_unsigned_t value) override { return put(value) != nullptr; }
  bool number_float(number_float_t value, const string_t&) override {
    return put(value) != nullptr;
  }
  bool string(string_t& value) override { return put(std::move(value)) != nullptr; }
  bool binary(binary_t&) override { return refuse("holds bytes"); }  // not in JSON as text

  bool start_object(std::size_t) override { return open(json::object()); }
  bool start_array(std::size_t) override { return open(json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(string_t& name) override {
    const auto [entry, is_new] =
        open_.back()->get_ref<json::object_t&>().try_emplace(std::move(name));
    value_ = &entry->second;
    return is_new ||
           refuse("has the key " + json(entry->first).dump(-1, ' ', true).substr(0, kShownKey) +
                  " twice in one object");
  }

  bool parse_error(std::size_t position, const std::string&,
                   const nlohmann::detail::exception&) override {
    position_ = position;
    return false;
  }

  json take() { return std::move(root_); }

  /// What is wrong with `text`, once the parser stopped.
  std::string fault(std::string_view text) const {
    if (!fault_.empty()) return fault_;
    const std::string_view before = text.substr(0, std::min(position_, text.size()));
    const std::size_t line_begin = before.rfind('\n') + 1;  // npos + 1 = 0
    return concat("is not JSON: line ", 1 + std::count(before.begin(), before.end(), '\n'),
                  ", column ", std::max<std::size_t>(before.size() - line_begin, 1),
                  before.size() == text.size() ? ", where it ends" : "");
  }

 private:
  bool refuse(std::string fault) {
    fault_ = std::move(fault);
    return false;
  }

  json* put(json value) {
    if (open_.empty()) return &(root_ = std::move(value));
    if (open_.back()->is_object()) return &(*value_ = std::move(value));
    auto& list = open_.back()->get_ref<json::array_t&>();
    list.push_back(std::move(value));
    return &list.back();
  }

  bool open(json value) {
    if (open_.size() == kDeepestDocument)
      return refuse(concat("is nested more than ", kDeepestDocument, " levels deep"));
    open_.push_back(put(std::move(value)));
    return true;
  }

  bool close() {
    open_.pop_back();
    return true;
  }

  json root_;
  std::vector<json*> open_;  ///< lists and objects that have not ended, outermost first
  json* value_ = nullptr;    ///< of the last key
  std::string fault_;        ///< of ours; empty: the parser's, at position_
  std::size_t position_ = 0;
};

}  // namespace

json parse_json(std::string_view text, const std::string& name, std::size_t most_bytes) {
  check_bounded_text(text, name, most_bytes);
  Builder builder;
  if (!json::sax_parse(text, &builder)) throw Error(concat(name, " ", builder.fault(text)));
  return builder.take();
}

json read_json(const std::filesystem::path& file, std::size_t most_bytes) {
  return parse_json(read_bounded_text(file, most_bytes), file.string(), most_bytes);
}

}  // namespace ovimap
