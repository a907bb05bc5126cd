// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/truth/truth_replica.h"

#include <algorithm>
#include <cctype>
#include <unordered_map>

#include <nlohmann/json.hpp>

#include "ovimap/base/bounded_json.h"
#include "ovimap/base/error.h"
#include "ovimap/io/mesh/ply.h"

namespace ovimap {

namespace {

namespace fs = std::filesystem;

constexpr const char* kMesh = "mesh_semantic.ply";
constexpr const char* kInfo = "info_semantic.json";
constexpr const char* kFaceProperty = "object_id";

template <class Read>
void read_info(const fs::path& path, Read&& read) {
  const nlohmann::json document = read_json(path, kLargeDocument);
  try {
    read(document);
  } catch (const nlohmann::json::exception&) {
    throw Error(concat("'", path.string(), "' is not Replica's info_semantic.json: expected are ",
                       "classes with id and name, and objects with id, class_id and class_name"));
  }
}

/// Replica's own name of a scene of NICE-SLAM's pack: "room_0" for "room0".
std::string published_name(const std::string& scene) {
  const auto digit = std::find_if(scene.begin(), scene.end(),
                                  [](unsigned char c) { return std::isdigit(c) != 0; });
  return std::string(scene.begin(), digit) + "_" + std::string(digit, scene.end());
}

/// For each vertex the id that most of the triangles around it have.
std::vector<std::int32_t> ids_of_vertices(const ValuedMesh& valued) {
  std::vector<std::pair<std::uint32_t, std::int32_t>> corners;  // vertex, id
  corners.reserve(3 * valued.values.size());
  for (std::size_t i = 0; i < valued.values.size(); ++i)
    for (const std::uint32_t vertex : valued.mesh.triangles[i])
      corners.emplace_back(vertex, valued.values[i]);
  std::sort(corners.begin(), corners.end());
  std::vector<std::int32_t> ids(valued.mesh.vertices.size(), 0);
  std::vector<std::ptrdiff_t> most(ids.size(), 0);
  for (auto begin = corners.begin(); begin != corners.end();) {
    const auto end = std::upper_bound(begin, corners.end(), *begin);
    if (end - begin > most[begin->first]) {
      most[begin->first] = end - begin;
      ids[begin->first] = begin->second;
    }
    begin = end;
  }
  return ids;
}

std::unordered_map<std::int32_t, std::int32_t> classes_of_objects(const fs::path& info) {
  std::unordered_map<std::int32_t, std::int32_t> classes;
  read_info(info, [&](const nlohmann::json& document) {
    for (const auto& object : document.at("objects"))
      classes[object.at("id").get<std::int32_t>()] = object.at("class_id").get<std::int32_t>();
  });
  return classes;
}

}  // namespace

std::vector<fs::path> replica_annotation_folders(const fs::path& scene) {
  const fs::path published = scene.parent_path() / published_name(scene.filename().string());
  return {scene, scene / "habitat", published, published / "habitat"};
}

fs::path find_replica_semantic_mesh(const fs::path& scene) {
  for (const fs::path& folder : replica_annotation_folders(scene))
    if (fs::exists(folder / kMesh)) return folder / kMesh;
  return {};
}

Truth load_replica_semantic_mesh(const fs::path& mesh) {
  const fs::path info = mesh.parent_path() / kInfo;
  if (!fs::exists(info))
    throw Error(concat("the truth of '", mesh.string(), "' lacks the file '", info.string(),
                       "', which names its objects; it lies beside the mesh in Replica"));
  ValuedMesh valued = read_ply_with(mesh, kFaceProperty);
  if (valued.mesh.vertices.empty())
    throw Error(concat("the truth mesh '", mesh.string(), "' has no vertices"));
  Truth truth;
  truth.instances = ids_of_vertices(valued);
  const auto classes = classes_of_objects(info);
  for (const std::int32_t id : truth.instances) {
    const auto found = classes.find(id);
    truth.classes.push_back(found == classes.end() ? 0 : std::max(found->second, 0));
  }
  truth.mesh = std::move(valued.mesh);
  truth.mesh.labels.clear();
  read_replica_names(info, truth);
  return truth;
}

void read_replica_names(const fs::path& info_semantic, Truth& truth) {
  read_info(info_semantic, [&](const nlohmann::json& document) {
    for (const auto& entry : document.at("classes"))
      truth.class_names[entry.at("id").get<std::int32_t>()] = entry.at("name").get<std::string>();
    for (const auto& object : document.at("objects"))
      truth.instance_names[object.at("id").get<std::int32_t>()] =
          object.at("class_name").get<std::string>();
  });
}

}  // namespace ovimap
