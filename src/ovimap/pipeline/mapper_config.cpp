// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/mapper_config.h"

#include <yaml-cpp/yaml.h>

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

void list_fields(MapperConfig& config, ConfigFields& fields) {
  fields.group("segment", [&](ConfigFields& f) { list_fields(config.segment, f); });
  fields.group("mask_fusion", [&](ConfigFields& f) { list_fields(config.mask_fusion, f); });
  fields.group("association", [&](ConfigFields& f) { list_fields(config.association, f); });
  fields.group("instance", [&](ConfigFields& f) { list_fields(config.instance, f); });
  fields.group("summary", [&](ConfigFields& f) { list_fields(config.summary, f); });
  fields.group("map", [&](ConfigFields& f) { list_fields(config.map, f); });
  fields.add("mask_interval", config.mask_interval, 1, 1000000, "2D masks every n-th frame");
  fields.add("max_range_m", config.max_range_m, 0.1f, 1000.f, "how far the map is projected back, metres");
}

void load_config(const std::filesystem::path& path, ConfigFields& fields) {
  try {
    set_fields(YAML::LoadFile(path.string()), "", fields);
  } catch (const YAML::BadFile&) {
    throw Error(concat("config file ", path.string(), " cannot be read; check the path"));
  } catch (const YAML::Exception& error) {
    throw Error(concat("config file ", path.string(), " is not valid YAML: ", error.what()));
  }
}

}  // namespace ovimap
