// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/classes/class_names.h"

#include <algorithm>
#include <array>
#include <map>

#include "ovimap/base/error.h"
#include "ovimap/semantics/words/word_lists.h"

namespace ovimap {

namespace {

constexpr std::array kTableColumns = {"replica51", "scannet200", "scannet20"};
using TableRow = std::array<std::string, kTableColumns.size()>;

std::string plain(std::string name) {
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == '-' || c == '_'; }, ' ');
  return name;
}

std::optional<std::size_t> position_of(const LabelSet& set, const std::string& name) {
  for (std::size_t i = 0; i < set.labels.size(); ++i)
    if (plain(set.labels[i].name) == plain(name)) return i;
  return std::nullopt;
}

/// "a; b; c" -> {"a", "b", "c"}
std::vector<std::string> cells_of(const std::string& line) {
  constexpr std::string_view kSeparator = "; ";
  std::vector<std::string> cells;
  std::size_t begin = 0;
  for (std::size_t end = 0; end != std::string::npos; begin = end + kSeparator.size()) {
    end = line.find(kSeparator, begin);
    cells.push_back(line.substr(begin, end == std::string::npos ? end : end - begin));
  }
  return cells;
}

const std::map<std::string, TableRow>& room_table() {
  static const std::map<std::string, TableRow> table = [] {
    std::map<std::string, TableRow> rows;
    for (const std::string& line : list_entries(builtin_word_list("room_classes"))) {
      const std::vector<std::string> cells = cells_of(line);
      OVIMAP_ASSERT(cells.size() == 1 + kTableColumns.size());
      std::copy(cells.begin() + 1, cells.end(), rows[cells[0]].begin());
    }
    return rows;
  }();
  return table;
}

std::vector<LabelGroup> scannet200_groups(const LabelSet& set) {
  std::vector<LabelGroup> groups;
  for (const std::string& line : list_entries(builtin_word_list("scannet200_groups"))) {
    const std::size_t blank = line.find(' ');
    const std::string group = line.substr(0, blank);
    if (groups.empty() || groups.back().name != group) groups.push_back({group, {}});
    const auto label = position_of(set, line.substr(blank + 1));
    OVIMAP_ASSERT(label.has_value());
    groups.back().labels.push_back(*label);
  }
  return groups;
}

std::vector<LabelGroup> thirds(const LabelSet& set) {
  std::vector<LabelGroup> groups = {{"head", {}}, {"common", {}}, {"tail", {}}};
  for (std::size_t i = 0; i < set.labels.size(); ++i)
    groups[i * groups.size() / set.labels.size()].labels.push_back(i);
  return groups;
}

}  // namespace

std::optional<std::size_t> find_class(const LabelSet& set, const std::string& name) {
  if (const auto same = position_of(set, name)) return same;
  if (!set.built_in) return std::nullopt;
  const auto column = std::find(kTableColumns.begin(), kTableColumns.end(), set.name);
  const auto row = room_table().find(plain(name));
  if (column == kTableColumns.end() || row == room_table().end()) return std::nullopt;
  return position_of(set, row->second[static_cast<std::size_t>(column - kTableColumns.begin())]);
}

std::vector<LabelGroup> label_groups(const LabelSet& set) {
  if (!set.built_in) return {};
  if (set.name == "scannet200") return scannet200_groups(set);
  if (set.name == "replica51") return thirds(set);
  return {};
}

std::vector<std::size_t> stuff_labels(const LabelSet& set) {
  const bool scannet = set.built_in && set.name.starts_with("scannet");
  std::vector<std::size_t> labels;
  for (std::size_t i = 0; i < set.labels.size(); ++i) {
    const std::string& name = set.labels[i].name;
    if (name == "wall" || name == "floor" || (name == "ceiling" && !scannet)) labels.push_back(i);
  }
  return labels;
}

}  // namespace ovimap
