// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/evaluation/truth_classes.h"

#include <algorithm>
#include <set>

#include "ovimap/base/error.h"
#include "ovimap/semantics/classes/class_names.h"

namespace ovimap {

namespace {

constexpr std::int32_t kReplicaUnlabelled = 256;  // besides -1 and -2

std::int32_t number_of(const LabelSet& set, const std::string& name) {
  const auto found = find_class(set, name);
  return found ? static_cast<std::int32_t>(*found) + 1 : 0;
}

std::int32_t number_of_own_id(const LabelSet& set, std::int32_t id, const TruthClasses& truth) {
  if (set.built_in && set.name == "replica51" && id == kReplicaUnlabelled) return 0;
  for (std::size_t i = 0; i < set.labels.size(); ++i)
    if (set.labels[i].id == id) return static_cast<std::int32_t>(i) + 1;
  throw Error(concat("the truth of '", truth.source.string(), "' has class id ", id,
                     ", which is not one of ", set.name,
                     "; choose the set it was labelled with (--classes), or name its classes in ",
                     "labels.json"));
}

std::int32_t number_of_named_id(const LabelSet& set, std::int32_t id, const TruthClasses& truth) {
  const auto name = truth.names.find(id);
  if (name == truth.names.end())
    throw Error(concat("the truth of '", truth.source.string(), "' has class id ", id,
                       ", which its labels.json does not name; add it under \"classes\", or make ",
                       "it 0 (unlabelled)"));
  return number_of(set, name->second);
}

}  // namespace

LabelSet label_set_of(const std::vector<TruthClasses>& truths) {
  std::set<std::string> names;
  for (const TruthClasses& truth : truths) {
    if (truth.names.empty())
      throw Error(concat("the truth of '", truth.source.string(),
                         "' does not name its classes; say which set they are from: --classes ",
                         "replica51, scannet200 or scannet20"));
    for (const auto& [id, name] : truth.names) names.insert(name);
  }
  LabelSet set{"truth", {}};
  for (const std::string& name : names)
    set.labels.push_back({static_cast<int>(set.labels.size()) + 1, name});
  return set;
}

NumberedClasses number_classes(const TruthClasses& truth, const LabelSet& set) {
  std::map<std::int32_t, std::int64_t> vertices_of_id;
  for (const std::int32_t id : truth.ids) ++vertices_of_id[id];
  NumberedClasses result;
  std::map<std::int32_t, std::int32_t> number_of_id;
  double labelled = 0, unknown = 0;
  for (const auto& [id, vertices] : vertices_of_id) {
    if (id <= 0) continue;
    const std::int32_t number =
        truth.names.empty() ? number_of_own_id(set, id, truth) : number_of_named_id(set, id, truth);
    number_of_id[id] = number;
    labelled += static_cast<double>(vertices);
    if (number > 0) continue;
    unknown += static_cast<double>(vertices);
    if (!truth.names.empty()) result.unknown.push_back(truth.names.at(id));
  }
  if (unknown == labelled)
    throw Error(concat("nothing in the truth of '", truth.source.string(),
                       "' has a class of the set ", set.name,
                       "; take the truth's own names (--classes truth) or another set"));
  result.unknown_share = unknown / labelled;
  for (const std::int32_t id : truth.ids)
    result.numbers.push_back(id > 0 ? number_of_id.at(id) : 0);
  return result;
}

}  // namespace ovimap
