// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/truth/truth.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <system_error>

#include <nlohmann/json.hpp>

#include "ovimap/base/bounded_json.h"
#include "ovimap/base/error.h"
#include "ovimap/image/codec.h"
#include "ovimap/io/mesh/ply.h"
#include "ovimap/io/truth/truth_replica.h"
#include "ovimap/io/truth/truth_scannet.h"

namespace ovimap {

namespace {

namespace fs = std::filesystem;

constexpr std::int32_t kReplicaUnlabelled = 256;  // of the published labels, besides -1 and -2

/// Whole numbers separated by white space; also those that were written as 1.2e+01.
std::vector<std::int32_t> read_labels(const fs::path& path) {
  const Bytes bytes = read_file(path);
  const char* at = reinterpret_cast<const char*>(bytes.data());
  const char* const end = at + bytes.size();
  std::vector<std::int32_t> labels;
  for (;;) {
    while (at != end && (*at == ' ' || (*at >= '\t' && *at <= '\r'))) ++at;
    if (at == end) return labels;
    double value = 0;
    const auto result = std::from_chars(at, end, value);
    const auto label = static_cast<std::int32_t>(
        std::abs(value) <= std::numeric_limits<std::int32_t>::max() ? value : 0.5);
    if (result.ec != std::errc() || label != value)
      throw Error(concat("label file '", path.string(), "': entry ", labels.size() + 1,
                         " is no whole number; one label per vertex of the mesh is expected"));
    labels.push_back(label);
    at = result.ptr;
  }
}

std::vector<std::int32_t> read_labels_for(const Mesh& mesh, const fs::path& path) {
  std::vector<std::int32_t> labels = read_labels(path);
  if (labels.size() != mesh.vertices.size())
    throw Error(concat("label file '", path.string(), "' has ", labels.size(),
                       " labels, but its mesh has ", mesh.vertices.size(),
                       " vertices: the two are not of the same scene"));
  return labels;
}

std::map<std::int32_t, std::string> names_in(const nlohmann::json& document, const char* key) {
  std::map<std::int32_t, std::string> names;
  if (!document.contains(key)) return names;
  for (const auto& [id, name] : document.at(key).items())
    names[std::stoi(id)] = name.get<std::string>();
  return names;
}

void read_names(const fs::path& path, Truth& truth) {
  const nlohmann::json document = read_json(path, kLargeDocument);
  try {
    if (!document.is_object()) throw std::invalid_argument("not an object");
    truth.instance_names = names_in(document, "instances");
    truth.class_names = names_in(document, "classes");
    if (document.contains("unscored"))
      truth.unscored = document.at("unscored").get<std::set<std::int32_t>>();
  } catch (const std::exception&) {
    throw Error(
        concat("'", path.string(), "' is not of the form {\"instances\": {\"12\": \"sofa\"}, ",
               "\"classes\": {\"1\": \"sofa\"}, \"unscored\": [12]}; the last may be left out"));
  }
}

/// The folder of a recording, "ROOT/SCENE" also when it was given as "ROOT/SCENE/" or ".".
fs::path scene_folder(const fs::path& source) {
  std::error_code fault;
  const fs::path path = fs::canonical(source, fault);
  if (fault)
    throw Error(concat("there is no folder '", source.string(),
                       "' to take the truth from; give the scene's folder ROOT/SCENE"));
  return fs::is_directory(path) ? path : path.parent_path();
}

fs::path existing(const fs::path& path, const fs::path& source) {
  if (!fs::exists(path))
    throw Error(concat("the truth of '", source.string(), "' lacks the file '", path.string(),
                       "'; it should lie beside the scene's folder (Replica layout)"));
  return path;
}

void find_names(const fs::path& folder, Truth& truth) {
  for (const fs::path& names : {folder / "labels.json", folder.parent_path() / "labels.json"})
    if (fs::exists(names)) return read_names(names, truth);
  for (const fs::path& place : replica_annotation_folders(folder))
    if (const fs::path names = place / "info_semantic.json"; fs::exists(names)) {
      std::replace(truth.classes.begin(), truth.classes.end(), kReplicaUnlabelled, 0);
      return read_replica_names(names, truth);
    }
}

/// The labels of each vertex, in ROOT or in the folder in which they are published for the pack.
fs::path find_labels(const fs::path& root, const std::string& name, const char* published_in) {
  const fs::path published = root / published_in / name;
  return fs::exists(root / name) || !fs::exists(published) ? root / name : published;
}

Truth load_replica_truth(const fs::path& folder, const fs::path& source) {
  const fs::path root = folder.parent_path();
  const std::string scene = folder.filename().string();
  const fs::path instance_path =
      find_labels(root, "instance_labels_" + scene + ".txt", "replica_gt_instances");
  const fs::path class_path =
      find_labels(root, "semantic_labels_" + scene + ".txt", "replica_gt_semantics");
  if (!fs::exists(instance_path))
    if (const fs::path mesh = find_replica_semantic_mesh(folder); !mesh.empty())
      return load_replica_semantic_mesh(mesh);
  const fs::path mesh_path = existing(root / (scene + "_mesh.ply"), source);
  existing(instance_path, source);
  Truth truth;
  truth.mesh = read_ply(mesh_path);
  truth.mesh.labels.clear();
  if (truth.mesh.vertices.empty())
    throw Error(concat("the truth mesh '", mesh_path.string(), "' has no vertices"));
  truth.instances = read_labels_for(truth.mesh, instance_path);
  if (fs::exists(class_path)) truth.classes = read_labels_for(truth.mesh, class_path);
  find_names(folder, truth);
  return truth;
}

}  // namespace

Truth load_truth(const fs::path& source, ScanNetClasses scannet_classes) {
  const fs::path folder = scene_folder(source);
  if (!fs::exists(folder.parent_path() / (folder.filename().string() + "_mesh.ply")))
    if (const fs::path mesh = find_scannet_mesh(folder); !mesh.empty())
      return load_scannet_truth(mesh, scannet_classes);
  return load_replica_truth(folder, source);
}

}  // namespace ovimap
