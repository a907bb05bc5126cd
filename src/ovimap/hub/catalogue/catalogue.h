// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace ovimap {

/// A network on the model hub that is known to fit.
struct CatalogueEntry {
  std::string name, kind;
  std::string repository, revision;
  std::map<std::string, std::string> files;  ///< network: path, without variant and ".onnx"
  std::map<std::string, double> size_mb;     ///< variant: about, in 10^6 bytes
  std::string license, good_for, documentation;
  int preference = 0;  ///< of encoders, for `auto`
  bool tried = false;  ///< by this project
};

/// "full", "fp16" or "quantized", and what a file of it is called by behind its name.
struct ModelVariant {
  std::string name, ending;
};
const std::vector<ModelVariant>& model_variants();

/// src/ovimap/hub/catalogue/catalogue.yaml.
std::string_view builtin_catalogue();

/// The catalogue in `text`, which `name` names in faults. Throws Error naming what is missing.
std::vector<CatalogueEntry> parse_catalogue(std::string_view text, const std::string& name);

/// The built-in catalogue, or the one in `file` if that is not empty.
std::vector<CatalogueEntry> read_catalogue(const std::filesystem::path& file);

/// Throws Error, with the likeliest name meant, where there is none of that name.
const CatalogueEntry& find_entry(const std::vector<CatalogueEntry>& catalogue,
                                 const std::string& name);

/// What a laptop without a GPU does well with.
inline constexpr const char* kFirstEncoder = "siglip-base-224";

}  // namespace ovimap
