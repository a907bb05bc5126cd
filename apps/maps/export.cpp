// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <functional>

#include "apps/command/command.h"
#include "export.h"
#include "ovimap/base/parallel.h"
#include "ovimap/image/codec.h"
#include "ovimap/io/exports/glb.h"
#include "ovimap/io/exports/instance_csv.h"
#include "ovimap/io/exports/instance_json.h"
#include "ovimap/io/exports/object_folder.h"
#include "ovimap/io/map_file/map_edits.h"
#include "ovimap/io/mesh/map_mesh.h"
#include "ovimap/io/mesh/ply.h"
#include "ovimap/io/pictures/palette.h"
#include "ovimap/io/pictures/pictures.h"
#include "ovimap/pipeline/grids/grid_files.h"
#include "ovimap/pipeline/search/object_labels.h"
#include "ovimap/pipeline/search/scene_graph.h"
#include "ovimap/pipeline/search/scene_graph_json.h"

namespace ovimap::apps {

namespace {

/// Colours a mesh with instance ids as labels as --what says.
std::function<void(Mesh&)> coloring_of(const ExportOptions& options) {
  if (options.what == "instances")
    return [](Mesh& mesh) { mesh.colors = instance_colors(mesh.labels); };
  if (options.what == "semantic")
    return [classes = classify(options)](Mesh& mesh) { mesh.colors = class_colors(mesh, classes); };
  if (options.what == "points") return [](Mesh& mesh) { mesh.triangles.clear(); };
  return [](Mesh&) {};
}

/// The map's surface, never as a whole in memory, colours and labels as --what says.
MeshParts colored_parts(const MapDocument& document, const ExportOptions& options) {
  return visible_parts(document, options.map, coloring_of(options));
}

std::vector<ObjectRelation> relations_of(const MapSearch& search) {
  return find_relations(ids_of(search.index), search.scene.shapes.whole());
}

ObjectLabels labels_in(const MapSearch& search, const ExportOptions& options) {
  return read_labels(search, options.encoder, options.model_dirs);
}

/// Rooms, places, objects and relations.
void export_scene_graph(const ExportOptions& options) {
  const MapSearch search = open_map_search(options.map);
  const SceneGraph graph =
      read_scene_graph(options.map, search, options.encoder, options.model_dirs);
  write_text(options.out, scene_graph_json(graph, search));
}

void export_json(const ExportOptions& options) {
  if (options.what == "semantic") return export_class_json(options);
  if (options.what == "rooms") return export_scene_graph(options);
  const MapSearch search = open_map_search(options.map);
  write_text(options.out, scene_json(options.map, search.info, labels_in(search, options),
                                     relations_of(search)) +
                              "\n");
}

void export_csv(const ExportOptions& options) {
  const MapSearch search = open_map_search(options.map);
  write_text(options.out,
             instances_csv(search.info.instances, {search.info.names, labels_in(search, options)}));
}

void export_ply(const ExportOptions& options) {
  const MapDocument document = load_corrected_map(options.map);
  if (options.what != "semantic") return write_ply(options.out, colored_parts(document, options));
  const auto to_classes = [classes = classify(options)](Mesh& part) {
    label_by_class(part, classes);
    part.colors = instance_colors(part.labels);
  };
  write_ply(options.out, visible_parts(document, options.map, to_classes));
}

void export_glb(const ExportOptions& options) {
  const ObjectLabels labels = labels_in(open_map_search(options.map), options);
  const MapDocument document = load_corrected_map(options.map);
  const ObjectTitles titles{document.names, labels};
  write_glb(options.out, colored_parts(document, options),
            {document.instances, document.parts, titles, document.up});
}

void export_png(const ExportOptions& options) {
  const MapDocument document = load_corrected_map(options.map);
  constexpr MeshColoring kOwn[] = {MeshColoring::kColors};
  const auto pictures = top_down(colored_parts(document, options), document.up, kOwn);
  write_file(options.out, encode_png(pictures.front()));
}

void export_grid(const ExportOptions& options) {
  OccupancyConfig config;
  config.cell_m = options.cell_m;
  const OccupancyGrid grid = make_occupancy_grid(load_corrected_map(options.map), config);
  const std::vector<GridSlice> layers = layers_of(grid, options.heights_m);
  write_grid_slice(options.out, grid, band_of(grid, options.band_m[0], options.band_m[1], config));
  for (std::size_t i = 0; i < layers.size(); ++i)
    write_grid_slice(layer_path(options.out, options.heights_m[i]), grid, layers[i]);
}

void export_folder(const ExportOptions& options) {
  const MapDocument document = load_corrected_map(options.map);
  const MapSearch search = open_map_search(options.map);
  const auto relations = relations_of(search);
  const ObjectLabels labels = labels_in(search, options);
  write_object_folder(options.out, document, labels, colored_parts(document, options), relations,
                      scene_json(options.map, search.info, labels, relations) + "\n");
}

struct Format {
  const char* ending;
  void (*write)(const ExportOptions&);
  const char* whats;  ///< what it can show; the first is the default
};
constexpr Format kFormats[] = {
    {".ply", export_ply, "mesh instances semantic points"},
    {".glb", export_glb, "mesh instances semantic"},
    {".png", export_png, "mesh instances semantic"},
    {".json", export_json, "objects rooms semantic mesh instances"},
    {".csv", export_csv, "objects"},
    {".yaml", export_grid, "grid"},
    {"", export_folder, "objects mesh instances semantic"},
};

const Format& format_of(const ExportOptions& options) {
  const std::string ending =
      std::filesystem::is_directory(options.out) ? "" : options.out.extension().string();
  for (const Format& format : kFormats)
    if (ending == format.ending) return format;
  throw Error(
      concat("cannot export to '", options.out.string(),
             "'; the name must end in .ply, .glb, .png, .json, .csv or .yaml, or be that of "
             "a new folder"));
}

/// The default where --what is not given; refuses what the format cannot show.
std::string checked_what(const Format& format, const std::string& what) {
  std::istringstream words(format.whats);
  std::string word, accepted, first;
  while (words >> word) {
    if (first.empty()) first = word;
    if (word == what) return what;
    accepted += (accepted.empty() ? "" : ", ") + word;
  }
  if (what.empty()) return first;
  throw Error(concat("--what ", what, " does not go into ",
                     *format.ending ? format.ending : "a folder", "; it takes ", accepted));
}

int export_map(ExportOptions options) {
  const ThreadLimit limit(options.threads);
  const Format& format = format_of(options);
  options.what = checked_what(format, options.what);
  if (*format.ending)
    check_file_target(options.out);
  else
    check_new_folder(options.out);
  format.write(options);
  if (options.json)
    print_json(
        {{"map", options.map.string()}, {"out", options.out.string()}, {"what", options.what}});
  else
    std::printf("%s: %s\n", options.out.c_str(), options.what.c_str());
  return kDone;
}

void add_grid_options(CLI::App& command, ExportOptions& options) {
  command.add_option("--cell", options.cell_m, "of a grid: edge of a cell, metres")
      ->check(CLI::Range(0.001, 100.))
      ->capture_default_str();
  command
      .add_option(
          "--band", options.band_m,
          "of a grid: heights above the floor between which things stand in the way, metres")
      ->delimiter(',')
      ->capture_default_str();
  command
      .add_option("--heights", options.heights_m,
                  "of a grid: also the layers at these heights above the floor, metres")
      ->delimiter(',')
      ->type_size(1)
      ->allow_extra_args(false);
}

}  // namespace

Action add_export(CLI::App& command) {
  auto options = std::make_shared<ExportOptions>();
  command.add_option("MAP", options->map, "map file")->required();
  command
      .add_option("OUT", options->out,
                  "file to write: .ply or .glb (mesh), .png (from above), .json (objects and how "
                  "they stand to each other), .csv (objects), .yaml (occupancy grid, ESDF), or a "
                  "new folder (one folder per object)")
      ->required();
  command
      .add_option(
          "--what", options->what,
          "mesh: true colours; instances: a colour per object; semantic: a colour and id per "
          "class; points: vertices alone; objects; rooms: places, rooms and what is in them; grid. "
          "Each "
          "format has its own default")
      ->check(
          CLI::IsMember({"mesh", "instances", "semantic", "points", "objects", "rooms", "grid"}));
  add_grid_options(command, *options);
  command
      .add_option("--classes", options->classes,
                  "of --what semantic: replica51, scannet200, scannet20 or a file of names")
      ->capture_default_str();
  command.add_option("--encoder", options->encoder,
                     "of --what semantic and rooms; auto: the model the map was made with");
  add_model_dirs(command, options->model_dirs);
  command.add_option("--threads", options->threads, "threads to use; 0: all cores")
      ->check(CLI::Range(0, 1024));
  command.add_flag("--json", options->json, "print one JSON object");
  return [options] { return export_map(*options); };
}

}  // namespace ovimap::apps
