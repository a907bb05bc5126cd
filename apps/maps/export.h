// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "ovimap/geometry/mesh.h"
#include "ovimap/semantics/classes/label_set.h"

namespace ovimap::apps {

struct ExportOptions {
  std::filesystem::path map, out;
  std::string what;  ///< empty: the format's own
  std::string classes = "scannet200";
  std::string encoder = "auto";
  std::vector<std::filesystem::path> model_dirs;
  float cell_m = 0.05f;
  std::array<float, 2> band_m = {0.1f, 1.5f};
  std::vector<float> heights_m;
  int threads = 0;
  bool json = false;
};

/// The class of every instance that has an embedding.
struct ClassedMap {
  LabelSet set;
  std::map<InstanceId, ClassGuess> guesses;
};
ClassedMap classify(const ExportOptions& options);

/// Replaces instance ids by class ids; 0 where no class is known.
void label_by_class(Mesh& mesh, const ClassedMap& classes);

/// A colour per class for a mesh labelled with instance ids.
std::vector<std::array<std::uint8_t, 3>> class_colors(const Mesh& mesh, const ClassedMap& classes);

/// `ovimap info` with the class of each instance, to options.out.
void export_class_json(const ExportOptions& options);

}  // namespace ovimap::apps
