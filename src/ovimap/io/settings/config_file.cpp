// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/settings/config_file.h"

#include <yaml-cpp/yaml.h>

#include "ovimap/base/bounded_yaml.h"
#include "ovimap/base/error.h"

namespace ovimap {

namespace {

void set_fields(const YAML::Node& node, const std::string& prefix, ConfigFields& fields) {
  for (const auto& entry : node) {
    const std::string name = prefix + entry.first.as<std::string>();
    if (entry.second.IsMap())
      set_fields(entry.second, name + ".", fields);
    else if (entry.second.IsScalar())
      fields.set(name, entry.second.as<std::string>());
    else
      throw Error(concat("setting ", name, " must be one value"));
  }
}

}  // namespace

void load_config(const std::filesystem::path& path, ConfigFields& fields) {
  const YAML::Node root = read_yaml(path, kSmallDocument);
  if (!root.IsMap() && !root.IsNull())
    throw Error(concat("config file ", path.string(), " must hold 'name: value' lines"));
  set_fields(root, "", fields);
}

}  // namespace ovimap
