// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/command/command.h"
#include "export.h"
#include "ovimap/image/codec.h"
#include "ovimap/io/exports/instance_json.h"
#include "ovimap/io/map_file/map_file.h"
#include "ovimap/io/pictures/palette.h"
#include "ovimap/pipeline/search/map_search.h"
#include "ovimap/semantics/query/query_engine.h"

namespace ovimap::apps {

ClassedMap classify(const ExportOptions& options) {
  constexpr std::size_t kBestOnly = 1;
  ClassedMap result{read_label_set(options.classes), {}};
  RuntimeConfig runtime;
  runtime.threads = options.threads;
  const MapSearch search = open_map_search(options.map);
  const auto encoder =
      needed_encoder_of_map(search.info.encoder, options.encoder, runtime, options.model_dirs);
  const QueryEngine engine(search.index, encoder.get(), {}, {}, search.scene);
  const auto guesses = project_classes(search.index, *engine.matcher(), result.set, kBestOnly);
  for (std::size_t i = 0; i < guesses.size(); ++i)
    if (!guesses[i].empty()) result.guesses[search.index.object(i).id] = guesses[i].front();
  return result;
}

void label_by_class(Mesh& mesh, const ClassedMap& classes) {
  for (std::uint32_t& label : mesh.labels) {
    const auto guess = classes.guesses.find(label);
    label = guess == classes.guesses.end()
                ? 0
                : static_cast<std::uint32_t>(classes.set.labels[guess->second.label].id);
  }
}

std::vector<std::array<std::uint8_t, 3>> class_colors(const Mesh& mesh, const ClassedMap& classes) {
  Mesh labels_only;
  labels_only.labels = mesh.labels;
  label_by_class(labels_only, classes);
  return instance_colors(labels_only.labels);
}

void export_class_json(const ExportOptions& options) {
  const ClassedMap classes = classify(options);
  auto document = nlohmann::json::parse(info_json(options.map, read_map_info(options.map)));
  document["classes"] = classes.set.name;
  for (auto& instance : document["instances"]) {
    const auto guess = classes.guesses.find(instance["id"].get<InstanceId>());
    if (guess == classes.guesses.end()) {
      instance["class"] = nullptr;
      continue;
    }
    const ClassLabel& label = classes.set.labels[guess->second.label];
    instance["class"] = {{"id", label.id}, {"name", label.name}, {"score", guess->second.score}};
  }
  const std::string text = json_text(document) + "\n";
  write_text(options.out, text);
}

}  // namespace ovimap::apps
