// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "command.h"
#include "ovimap/image/codec.h"
#include "ovimap/instance/instance_mesh.h"
#include "ovimap/io/instance_json.h"
#include "ovimap/io/map_file.h"
#include "ovimap/io/palette.h"
#include "ovimap/io/ply.h"
#include "ovimap/pipeline/map_pictures.h"

namespace ovimap::apps {

namespace {

struct ExportOptions {
  std::filesystem::path map, out;
  std::string what = "mesh";
  bool json = false;
};

void export_ply(const MapDocument& document, const ExportOptions& options) {
  Mesh mesh = extract_instance_mesh(document.map, document.instances);
  if (options.what == "instances") mesh.colors = instance_colors(mesh.labels);
  if (options.what == "points") mesh.triangles.clear();
  write_ply(options.out, mesh);
}

void write_text(const std::filesystem::path& path, const std::string& text) {
  write_file(path, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

int export_map(const ExportOptions& options) {
  const std::string kind = options.out.extension().string();
  if (kind == ".json") {
    const MapInfo info = read_map_info(options.map);
    write_text(options.out, info_json(options.map, info) + "\n");
  } else if (kind == ".ply") {
    export_ply(load_map(options.map), options);
  } else if (kind == ".png") {
    const auto coloring = options.what == "mesh" ? MeshColoring::kColors : MeshColoring::kInstances;
    write_file(options.out, encode_png(top_down_picture(load_map(options.map), coloring)));
  } else {
    throw Error(concat("cannot export to '", options.out.string(),
                       "'; the name must end in .ply, .json or .png"));
  }
  if (options.json)
    print_json(
        {{"map", options.map.string()}, {"out", options.out.string()}, {"what", options.what}});
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
      .add_option("--what", options->what,
                  "mesh: true colours; instances: a colour per object; points: vertices alone")
      ->check(CLI::IsMember({"mesh", "instances", "points"}))
      ->capture_default_str();
  command.add_flag("--json", options->json, "print one JSON object");
  return [options] { return export_map(*options); };
}

}  // namespace ovimap::apps
