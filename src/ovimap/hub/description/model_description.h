// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "ovimap/hub/catalogue/catalogue.h"
#include "ovimap/hub/transfer/hub.h"
#include "ovimap/inference/models/model_folder.h"

namespace ovimap {

/// What a catalogue entry becomes on this machine.
struct FetchTarget {
  CatalogueEntry entry;
  std::string variant;                       ///< of model_variants()
  HubListing listing;                        ///< the whole repository
  std::map<std::string, std::string> files;  ///< network: path, as fetched
  std::vector<HubFile> wanted;               ///< all that is fetched
};

/// The keys of model.yaml that depend on what a network is: in order, scalars alone.
struct ModelDescription {
  ImageInputSpec input;
  std::map<std::string, NetworkSpec> networks;
  std::vector<std::pair<std::string, std::string>> keys;
  std::vector<std::string> written;  ///< files that were made of fetched ones
};

/// Reads how the fetched files in `folder` are to be used: tensors and sizes from the networks,
/// preparation of images from preprocessor_config.json, texts from config.json and the tokenizer's
/// files. Throws Error when they are not what ovimap can run.
ModelDescription describe_model(const std::filesystem::path& folder, const FetchTarget& target);

/// Writes `folder`/model.yaml. `remarks` are further keys: what the self-test found.
void write_model_yaml(const std::filesystem::path& folder, const FetchTarget& target,
                      const ModelDescription& description,
                      const std::vector<std::pair<std::string, std::string>>& remarks);

}  // namespace ovimap
