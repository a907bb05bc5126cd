// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/base/bounded_yaml.h"

#include <set>
#include <sstream>
#include <vector>

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include "ovimap/base/error.h"

namespace ovimap {

namespace {

/// Follows the parser's events and ends the parse at the first thing that is not accepted.
class Inspector : public YAML::EventHandler {
 public:
  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override { begin(mark, nullptr); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    refuse(mark, "aliases (*name) are not accepted; write the value out");
  }
  void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                const std::string& value) override {
    begin(mark, &value);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    open(mark, false);
  }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {
    open(mark, true);
  }
  void OnSequenceEnd() override { levels_.pop_back(); }
  void OnMapEnd() override { levels_.pop_back(); }

  [[noreturn]] static void refuse(const YAML::Mark& mark, const std::string& what) {
    throw YAML::ParserException(mark, what);
  }

 private:
  struct Level {
    bool is_map = false;
    bool key_is_next = true;
    std::set<std::string> keys;
  };

  /// `scalar`: null where the node is none.
  void begin(const YAML::Mark& mark, const std::string* scalar) {
    if (levels_.empty() || !levels_.back().is_map) return;
    Level& map = levels_.back();
    if (map.key_is_next) {
      if (scalar == nullptr) refuse(mark, "a key must be a text");
      if (!map.keys.insert(*scalar).second) refuse(mark, "the map has this key already");
    }
    map.key_is_next = !map.key_is_next;
  }

  void open(const YAML::Mark& mark, bool is_map) {
    begin(mark, nullptr);
    if (levels_.size() == kDeepestDocument)
      refuse(mark, concat("nested more than ", kDeepestDocument, " levels deep"));
    levels_.emplace_back().is_map = is_map;
  }

  std::vector<Level> levels_;
};

/// Throws YAML::Exception.
void inspect(const std::string& text) {
  std::istringstream in(text);
  YAML::Parser parser(in);
  Inspector inspector;
  if (!parser.HandleNextDocument(inspector)) return;
  if (parser.HandleNextDocument(inspector))
    Inspector::refuse(YAML::Mark::null_mark(), "it holds a second document (---)");
}

}  // namespace

YAML::Node parse_yaml(const std::string& text, const std::string& name, std::size_t most_bytes) {
  check_bounded_text(text, name, most_bytes);
  try {
    inspect(text);
    return YAML::Load(text);
  } catch (const YAML::Exception& fault) {
    const std::string line = fault.mark.is_null() ? "" : concat("line ", fault.mark.line + 1, " ");
    throw Error(concat(name, ": ", line, "is not YAML that ovimap reads (", fault.msg, ")"));
  }
}

YAML::Node read_yaml(const std::filesystem::path& file, std::size_t most_bytes) {
  return parse_yaml(read_bounded_text(file, most_bytes), file.string(), most_bytes);
}

}  // namespace ovimap
