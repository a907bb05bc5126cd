// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/hub/catalogue/catalogue.h"

#include <yaml-cpp/yaml.h>

#include "ovimap/base/bounded_yaml.h"
#include "ovimap/base/edit_distance.h"
#include "ovimap/base/error.h"

namespace ovimap {

namespace {

std::string text_of(const YAML::Node& node, const char* key) {
  if (!node[key] || !node[key].IsScalar())
    throw Error(concat("'", key, "' is missing", node["name"] ? " of " : "",
                       node["name"] ? node["name"].as<std::string>() : "", "; add it"));
  return node[key].as<std::string>();
}

CatalogueEntry parse_entry(const YAML::Node& node) {
  CatalogueEntry entry;
  entry.name = text_of(node, "name");
  entry.kind = text_of(node, "kind");
  entry.repository = text_of(node, "repository");
  entry.revision = text_of(node, "revision");
  entry.license = text_of(node, "license");
  entry.good_for = text_of(node, "good_for");
  entry.documentation = text_of(node, "documentation");
  entry.tried = text_of(node, "tried") == "true";
  if (node["preference"]) entry.preference = node["preference"].as<int>();
  for (const auto& file : node["files"])
    entry.files[file.first.as<std::string>()] = file.second.as<std::string>();
  for (const auto& size : node["size_mb"])
    entry.size_mb[size.first.as<std::string>()] = size.second.as<double>();
  if (entry.files.size() != 2 || (entry.kind != "dual_encoder" && entry.kind != "sam"))
    throw Error(concat("'", entry.name, "' must be a dual_encoder or a sam, with two files"));
  return entry;
}

}  // namespace

const std::vector<ModelVariant>& model_variants() {
  static const std::vector<ModelVariant> variants = {
      {"full", ""}, {"fp16", "_fp16"}, {"quantized", "_quantized"}};
  return variants;
}

std::vector<CatalogueEntry> parse_catalogue(std::string_view text, const std::string& name) {
  std::vector<CatalogueEntry> catalogue;
  try {
    const YAML::Node root = parse_yaml(std::string(text), name, kSmallDocument);
    for (const YAML::Node& node : root["models"]) catalogue.push_back(parse_entry(node));
  } catch (const YAML::Exception& error) {
    throw Error(concat("catalogue ", name, ", line ", error.mark.line + 1, ": ", error.msg));
  } catch (const Error& error) {
    throw Error(concat("catalogue ", name, ": ", error.what()));
  }
  return catalogue;
}

std::vector<CatalogueEntry> read_catalogue(const std::filesystem::path& file) {
  if (file.empty()) return parse_catalogue(builtin_catalogue(), "catalogue.yaml");
  return parse_catalogue(read_bounded_text(file, kSmallDocument), file.string());
}

const CatalogueEntry& find_entry(const std::vector<CatalogueEntry>& catalogue,
                                 const std::string& name) {
  std::vector<std::string> names;
  std::string all;
  for (const CatalogueEntry& entry : catalogue) {
    if (entry.name == name) return entry;
    names.push_back(entry.name);
    all += (all.empty() ? "" : ", ") + entry.name;
  }
  const std::string likely = likely_word(name, names);
  throw Error(concat("no model '", name, "' can be fetched; ",
                     likely.empty() ? "there are " + all : "did you mean '" + likely + "'?"));
}

}  // namespace ovimap
