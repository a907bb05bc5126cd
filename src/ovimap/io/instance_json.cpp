// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/instance_json.h"

#include <charconv>
#include <cmath>

#include <nlohmann/json.hpp>

#include "ovimap/io/map_file_record.h"

namespace ovimap {

namespace {

using Json = nlohmann::ordered_json;

/// The number with as few digits as tell the float apart (0.1, not 0.10000000149); null unless
/// finite.
Json number(float value) {
  if (!std::isfinite(value)) return nullptr;
  char text[48];
  const char* end = std::to_chars(text, text + sizeof(text), value).ptr;
  double shortest = 0;
  std::from_chars(text, end, shortest);
  return shortest;
}

Json vector(const Eigen::Vector3f& v) {
  return Json::array({number(v.x()), number(v.y()), number(v.z())});
}

Json instance_list(std::span<const InstanceSummary> instances,
                   const std::map<InstanceId, std::string>& names) {
  Json list = Json::array();
  for (const InstanceSummary& instance : instances) {
    const auto name = names.find(instance.id);
    Json entry;
    entry["id"] = instance.id;
    entry["name"] = name == names.end() ? std::string() : name->second;
    entry["box"]["min"] = vector(instance.box.min());
    entry["box"]["max"] = vector(instance.box.max());
    entry["centroid"] = vector(instance.centroid);
    entry["points"] = instance.points;
    entry["views"] = instance.views;
    entry["superpoints"] = instance.super_points;
    list.push_back(std::move(entry));
  }
  return list;
}

std::string text_of(const Json& document) {
  constexpr int kCompact = -1;
  return document.dump(kCompact, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

std::string instances_json(std::span<const InstanceSummary> instances,
                           const std::map<InstanceId, std::string>& names) {
  Json document;
  document["instances"] = instance_list(instances, names);
  return text_of(document);
}

std::string info_json(const std::filesystem::path& path, const MapInfo& info) {
  Json document;
  document["map"] = path.string();
  document["schema"] = info.schema;
  document["frames"] = info.frames;
  document["mask_frames"] = info.mask_frames;
  document["instances"] = instance_list(info.instances, info.names);
  document["voxel_size_m"] = number(info.voxel_size_m);
  document["blocks"] = info.blocks;
  document["size_bytes"] = info.size_bytes;
  document["content_hash"] = hash_text(info.content_hash);
  document["source"] = info.source;
  document["version"] = info.version;
  document["config"] = info.config_text;
  return text_of(document);
}

}  // namespace ovimap
