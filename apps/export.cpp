// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "command.h"
#include "ovimap/base/parallel.h"
#include "ovimap/image/codec.h"
#include "ovimap/instance/instance_mesh.h"
#include "ovimap/io/instance_json.h"
#include "ovimap/io/map_file.h"
#include "ovimap/io/palette.h"
#include "ovimap/io/pictures.h"
#include "ovimap/io/ply.h"
#include "ovimap/pipeline/map_pictures.h"
#include "ovimap/pipeline/map_search.h"
#include "ovimap/semantics/label_set.h"

namespace ovimap::apps {

namespace {

struct ExportOptions {
  std::filesystem::path map, out;
  std::string what = "mesh";
  std::string classes = "scannet200";
  std::string encoder = "auto";
  std::vector<std::filesystem::path> model_dirs;
  int threads = 0;
  bool json = false;
};

/// The class of every instance that has an embedding.
struct ClassedMap {
  LabelSet set;
  std::map<InstanceId, ClassGuess> guesses;
};

ClassedMap classify(const ExportOptions& options) {
  constexpr std::size_t kBestOnly = 1;
  ClassedMap result{read_label_set(options.classes), {}};
  RuntimeConfig runtime;
  runtime.threads = options.threads;
  const MapSearch search = open_map_search(options.map);
  const auto encoder =
      needed_encoder_of_map(search.info.encoder, options.encoder, runtime, options.model_dirs);
  const auto guesses = project_classes(search.index, *encoder, result.set, kBestOnly);
  for (std::size_t i = 0; i < guesses.size(); ++i)
    if (!guesses[i].empty()) result.guesses[search.index.object(i).id] = guesses[i].front();
  return result;
}

/// The map's mesh with class ids as labels and a colour per class; 0 where no class is known.
Mesh semantic_mesh(const MapDocument& document, const ClassedMap& classes,
                   const ExportOptions& options) {
  Mesh mesh = mesh_of(document, options.map);
  for (std::uint32_t& label : mesh.labels) {
    const auto guess = classes.guesses.find(label);
    label = guess == classes.guesses.end()
                ? 0
                : static_cast<std::uint32_t>(classes.set.labels[guess->second.label].id);
  }
  mesh.colors = instance_colors(mesh.labels);
  return mesh;
}

nlohmann::json semantic_json(const ExportOptions& options, const ClassedMap& classes) {
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
  return document;
}

void export_ply(const MapDocument& document, const ExportOptions& options) {
  Mesh mesh = mesh_of(document, options.map);
  if (options.what == "instances") mesh.colors = instance_colors(mesh.labels);
  if (options.what == "points") mesh.triangles.clear();
  write_ply(options.out, mesh);
}

void write_text(const std::filesystem::path& path, const std::string& text) {
  write_file(path, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

void export_semantic(const ExportOptions& options, const std::string& kind) {
  const ClassedMap classes = classify(options);
  if (kind == ".json")
    return write_text(options.out, json_text(semantic_json(options, classes)) + "\n");
  const MapDocument document = load_map(options.map);
  const Mesh mesh = semantic_mesh(document, classes, options);
  if (kind == ".ply") return write_ply(options.out, mesh);
  write_file(options.out, encode_png(top_down(mesh, document.up)));
}

void export_plain(const ExportOptions& options, const std::string& kind) {
  if (kind == ".json")
    return write_text(options.out, info_json(options.map, read_map_info(options.map)) + "\n");
  const MapDocument document = load_map(options.map);
  if (kind == ".ply") return export_ply(document, options);
  (void)mesh_of(document, options.map);
  const auto coloring = options.what == "mesh" ? MeshColoring::kColors : MeshColoring::kInstances;
  write_file(options.out, encode_png(top_down_picture(document, coloring)));
}

int export_map(const ExportOptions& options) {
  const ThreadLimit limit(options.threads);
  const std::string kind = options.out.extension().string();
  if (kind != ".json" && kind != ".ply" && kind != ".png")
    throw Error(concat("cannot export to '", options.out.string(),
                       "'; the name must end in .ply, .json or .png"));
  if (options.what == "semantic")
    export_semantic(options, kind);
  else
    export_plain(options, kind);
  if (options.json)
    print_json(
        {{"map", options.map.string()}, {"out", options.out.string()}, {"what", options.what}});
  else
    std::printf("%s: %s\n", options.out.c_str(), options.what.c_str());
  return kDone;
}

}  // namespace

Action add_export(CLI::App& command) {
  auto options = std::make_shared<ExportOptions>();
  command.add_option("MAP", options->map, "map file")->required();
  command
      .add_option(
          "OUT", options->out,
          "file to write: .ply (mesh with instance ids), .json (objects), .png (from above)")
      ->required();
  command
      .add_option(
          "--what", options->what,
          "mesh: true colours; instances: a colour per object; semantic: a colour and id per "
          "class; points: vertices alone")
      ->check(CLI::IsMember({"mesh", "instances", "semantic", "points"}))
      ->capture_default_str();
  command
      .add_option("--classes", options->classes,
                  "of --what semantic: replica51, scannet200, scannet20 or a file of names")
      ->capture_default_str();
  command.add_option("--encoder", options->encoder,
                     "of --what semantic; auto: the model the map was made with");
  add_model_dirs(command, options->model_dirs);
  command.add_option("--threads", options->threads, "threads to use; 0: all cores")
      ->check(CLI::Range(0, 1024));
  command.add_flag("--json", options->json, "print one JSON object");
  return [options] { return export_map(*options); };
}

}  // namespace ovimap::apps
