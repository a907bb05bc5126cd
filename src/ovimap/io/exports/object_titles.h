// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include "ovimap/instance/instance_summary.h"

namespace ovimap {

/// Household words for what objects clearly are.
using ObjectLabels = std::map<InstanceId, std::string>;

/// What objects are called.
struct ObjectTitles {
  std::map<InstanceId, std::string> names;  ///< that people gave
  ObjectLabels labels;

  std::string name_of(InstanceId id) const { return found(names, id); }
  std::string label_of(InstanceId id) const { return found(labels, id); }
  /// The name, else the label, else "".
  std::string title_of(InstanceId id) const {
    const std::string name = name_of(id);
    return name.empty() ? label_of(id) : name;
  }

 private:
  static std::string found(const std::map<InstanceId, std::string>& words, InstanceId id) {
    const auto word = words.find(id);
    return word == words.end() ? std::string() : word->second;
  }
};

}  // namespace ovimap
