// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// The search path of models; the model.yaml reader is in model_folder.cpp.
#include <algorithm>
#include <cstdlib>
#include <set>
#include <sstream>
#include <utility>

#include "ovimap/base/edit_distance.h"
#include "ovimap/base/error.h"
#include "ovimap/base/installation/installed_data.h"
#include "ovimap/base/listed.h"
#include "ovimap/inference/models/model_folder.h"

namespace ovimap {

namespace fs = std::filesystem;

namespace {

constexpr const char* kProjectFolder = ".models";

void append_environment(std::vector<fs::path>& folders) {
  const char* text = std::getenv("OVIMAP_MODELS");
  std::istringstream list(text ? text : "");
  for (std::string folder; std::getline(list, folder, ':');)
    if (!folder.empty()) folders.emplace_back(folder);
}

void append_above_program(std::vector<fs::path>& folders) {
  std::error_code absent;  // no /proc: the other places remain
  fs::path at = fs::read_symlink("/proc/self/exe", absent).parent_path();
  for (; at.has_relative_path(); at = at.parent_path()) folders.push_back(at / kProjectFolder);
}

ModelListing listing(const fs::path& folder) {
  ModelListing found{folder, folder.filename().string(), "", "", 0, "", false};
  try {
    const ModelFolder model = read_model_folder(folder);
    found.kind = model.kind;
    found.preference = std::atoi(model.extra("preference").c_str());
    found.variant = model.extra("variant");
    found.doubtful = model.extra("self_test") == "doubtful";
  } catch (const Error& error) {
    found.fault = error.what();
  }
  return found;
}

std::vector<fs::path> model_folders_in(const fs::path& place) {
  std::vector<fs::path> folders;
  std::error_code unreadable;
  for (const auto& entry : fs::directory_iterator(place, unreadable))
    if (fs::is_regular_file(entry.path() / "model.yaml")) folders.push_back(entry.path());
  std::sort(folders.begin(), folders.end());
  return folders;
}

}  // namespace

std::optional<fs::path> user_model_folder() {
  const char* data = std::getenv("XDG_DATA_HOME");
  const char* home = std::getenv("HOME");
  if (data && *data) return fs::path(data) / "ovimap" / "models";
  if (home && *home) return fs::path(home) / ".local/share/ovimap/models";
  return {};
}

std::vector<fs::path> model_search_path(const std::vector<fs::path>& model_dirs) {
  std::vector<fs::path> candidates = model_dirs;
  append_environment(candidates);
  candidates.emplace_back(kProjectFolder);
  append_above_program(candidates);
  if (const auto folder = user_model_folder()) candidates.push_back(*folder);
  if (const auto folder = installed_data("models")) candidates.push_back(*folder);

  std::vector<fs::path> folders;
  std::set<fs::path> seen;
  for (const fs::path& candidate : candidates) {
    std::error_code absent;
    const fs::path real = fs::canonical(candidate, absent);
    if (!absent && fs::is_directory(real) && seen.insert(real).second) folders.push_back(candidate);
  }
  return folders;
}

std::vector<ModelListing> list_models(const std::vector<fs::path>& search_path) {
  std::vector<ModelListing> models;
  std::set<std::string> names;
  for (const fs::path& place : search_path)
    for (const fs::path& folder : model_folders_in(place))
      if (names.insert(folder.filename().string()).second) models.push_back(listing(folder));
  return models;
}

fs::path named_model(const std::string& name, const std::vector<fs::path>& search_path) {
  return fs::is_regular_file(fs::path(name) / "model.yaml") ? fs::path(name)
                                                            : find_model(name, search_path);
}

fs::path find_model(const std::string& name, const std::vector<fs::path>& search_path,
                    std::vector<std::string> known) {
  for (const fs::path& place : search_path)
    if (fs::is_regular_file(place / name / "model.yaml")) return place / name;
  const std::string searched =
      listed(search_path, [](const fs::path& place) { return place.string(); });
  for (ModelListing& model : list_models(search_path)) known.push_back(std::move(model.name));
  const std::string likely = likely_word(name, known);
  throw Error(
      concat("model '", name, "' was not found in ", searched.empty() ? "any folder" : searched,
             likely.empty() ? "" : concat(", did you mean '", likely, "'?"),
             "; `ovimap models list` says what is there and what `ovimap models fetch NAME` "
             "gets (in a checkout tools/setup.sh gets the small ones), and --model-dir or "
             "OVIMAP_MODELS name other folders"));
}

}  // namespace ovimap
