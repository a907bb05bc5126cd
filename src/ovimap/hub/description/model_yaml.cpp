// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// Writes a fetched model's model.yaml; what is in it is found by model_description.cpp.
#include <yaml-cpp/yaml.h>

#include <fstream>

#include "ovimap/base/error.h"
#include "ovimap/hub/description/model_description.h"
#include "ovimap/inference/models/sha256.h"

namespace ovimap {

namespace fs = std::filesystem;

namespace {

void emit(YAML::Emitter& out, const std::string& key, const std::string& value) {
  out << YAML::Key << key << YAML::Value << value;
}

void emit_map(YAML::Emitter& out, const std::string& key,
              const std::map<std::string, std::string>& values) {
  out << YAML::Key << key << YAML::Value << YAML::Flow << YAML::BeginMap;
  for (const auto& [name, value] : values) emit(out, name, value);
  out << YAML::EndMap;
}

void emit_input(YAML::Emitter& out, const ImageInputSpec& input) {
  static const std::map<ResizeRule, std::string> rules = {{ResizeRule::kLongSide, "long_side"},
                                                          {ResizeRule::kStretch, "stretch"},
                                                          {ResizeRule::kShortSide, "short_side"}};
  out << YAML::Key << "input" << YAML::Value << YAML::BeginMap;
  emit(out, "size", std::to_string(input.size_px));
  emit(out, "resize", rules.at(input.resize));
  emit(out, "filter", input.filter == ResizeFilter::kBicubic ? "bicubic" : "bilinear");
  const auto numbers = [&out](const char* key, const std::array<float, 3>& values) {
    out << YAML::Key << key << YAML::Value << YAML::Flow << YAML::BeginSeq;
    for (const float value : values) out << value;
    out << YAML::EndSeq;
  };
  numbers("mean", input.mean);
  numbers("std", input.std);
  out << YAML::EndMap;
}

void emit_networks(YAML::Emitter& out, const std::map<std::string, NetworkSpec>& networks) {
  out << YAML::Key << "networks" << YAML::Value << YAML::BeginMap;
  for (const auto& [name, network] : networks) {
    out << YAML::Key << name << YAML::Value << YAML::BeginMap;
    emit(out, "file", network.file);
    if (!network.int8_file.empty()) emit(out, "int8_file", network.int8_file);
    emit_map(out, "inputs", network.inputs);
    emit_map(out, "outputs", network.outputs);
    out << YAML::EndMap;
  }
  out << YAML::EndMap;
}

/// What the hub listed, and what was made here, each with the digest that the hub or we know.
void emit_files(YAML::Emitter& out, const fs::path& folder, const FetchTarget& target,
                const ModelDescription& description) {
  std::map<std::string, std::string> sha256, git_blobs, bytes;
  for (const HubFile& file : target.wanted) {
    sha256[file.path] = file.sha256.empty() ? sha256_of_file(folder / file.path) : file.sha256;
    if (!file.git_blob.empty()) git_blobs[file.path] = file.git_blob;
    bytes[file.path] = std::to_string(file.bytes);
  }
  for (const std::string& file : description.written) {
    if (sha256.contains(file)) continue;
    sha256[file] = sha256_of_file(folder / file);
    bytes[file] = std::to_string(fs::file_size(folder / file));
  }
  const auto block = [&out](const char* key, const std::map<std::string, std::string>& values) {
    out << YAML::Key << key << YAML::Value << YAML::BeginMap;
    for (const auto& [name, value] : values) emit(out, name, value);
    out << YAML::EndMap;
  };
  block("sha256", sha256);
  block("git_blob", git_blobs);
  block("bytes", bytes);
}

}  // namespace

void write_model_yaml(const fs::path& folder, const FetchTarget& target,
                      const ModelDescription& description,
                      const std::vector<std::pair<std::string, std::string>>& remarks) {
  const CatalogueEntry& entry = target.entry;
  YAML::Emitter out;
  out.SetFloatPrecision(9);  // every float comes back as it was
  out << YAML::BeginMap;
  emit(out, "kind", entry.kind);
  emit(out, "name", target.variant == "full" ? entry.name : entry.name + " " + target.variant);
  emit(out, "license", entry.license);
  emit(out, "source", target.listing.repository);
  emit(out, "documentation", entry.documentation);
  emit(out, "catalogue", entry.name);
  emit(out, "revision", target.listing.commit);
  emit(out, "variant", target.variant);
  if (entry.preference > 0) emit(out, "preference", std::to_string(entry.preference));
  emit_input(out, description.input);
  emit_networks(out, description.networks);
  for (const auto& [key, value] : description.keys) emit(out, key, value);
  for (const auto& [key, value] : remarks) emit(out, key, value);
  emit_files(out, folder, target, description);
  out << YAML::EndMap;
  std::ofstream file(folder / "model.yaml");
  file << "# Written by `ovimap models fetch`. The licence of the weights is the key below.\n"
       << out.c_str() << '\n';
  file.close();
  if (!file) throw Error(concat("cannot write ", (folder / "model.yaml").string()));
}

}  // namespace ovimap
