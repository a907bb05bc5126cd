// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <limits>

#include "apps/command/command.h"
#include "ovimap/base/parallel.h"
#include "ovimap/io/map_file/map_file.h"
#include "ovimap/io/mesh/ply.h"
#include "ovimap/io/truth/truth.h"
#include "ovimap/pipeline/sequence/geometry_embedding.h"

namespace ovimap::apps {

namespace {

struct EmbedOptions {
  std::string mesh;
  std::filesystem::path ids, map;
  MappingOptions mapping;
  bool json = false;
};

std::vector<std::uint32_t> read_ids(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) throw Error(concat("file of instance ids ", path.string(), " cannot be read"));
  std::vector<std::uint32_t> ids;
  constexpr long long kLargest = std::numeric_limits<std::uint32_t>::max();
  for (long long id; file >> id;)  // what is too large stays too large, and is refused
    ids.push_back(static_cast<std::uint32_t>(std::clamp(id, 0LL, kLargest)));
  if (!file.eof())
    throw Error(concat("file of instance ids ", path.string(), ": entry ", ids.size() + 1,
                       " is no whole number; one id a line is expected"));
  return ids;
}

/// A PLY with ids, or "gt": the recording's own truth.
Mesh read_mesh(const EmbedOptions& options) {
  if (options.mesh != "gt") {
    Mesh mesh = read_ply(options.mesh);
    if (!options.ids.empty()) mesh.labels = read_ids(options.ids);
    if (!mesh.labels.empty() && mesh.labels.size() != mesh.vertices.size())
      throw Error(concat(options.ids.string(), " has ", mesh.labels.size(), " ids, but ",
                         options.mesh, " has ", mesh.vertices.size(), " vertices"));
    return mesh;
  }
  Truth truth = load_truth(options.mapping.source);
  truth.mesh.labels.clear();
  for (const std::int32_t id : truth.instances)
    truth.mesh.labels.push_back(id > 0 ? static_cast<std::uint32_t>(id) : 0);
  return std::move(truth.mesh);
}

int embed(const EmbedOptions& options) {
  const ThreadLimit limit(options.mapping.threads);
  const ProgramConfig program = read_program_config(options.mapping);
  check_map_target(options.map);
  const Mesh mesh = read_mesh(options);
  const auto source = open_frame_source(options.mapping.source, program.source);
  const auto range = positions(parse_frame_range(options.mapping.frames), source->size());
  GeometryEmbeddingConfig config;
  config.semantics = program.mapper.semantics;
  SequenceResult sequence;
  watch_for_interrupt();
  MapDocument document;
  {
    Progress progress("embedding");
    const auto encoder = make_encoder(options.mapping, program);
    document = embed_geometry(
        mesh, *source, range, config, encoder, sequence,
        [&](std::size_t done, std::size_t total, const FrameReport*) {
          progress.show(done, total);
          return !interrupted();
        },
        make_recognizer(options.mapping, program, encoder != nullptr));
  }
  document.source = source->kind() + ":" + options.mapping.source;
  save_map(options.map, document);
  if (options.json)
    print_json({{"map", options.map.string()},
                {"instances", document.instances.size()},
                {"frames", sequence.frames.size()},
                {"frames_skipped", sequence.skipped.size()},
                {"embedding_queries", embedding_queries(document.semantics)}});
  else
    std::printf("%s: %zu objects, %d views embedded from %zu frames\n", options.map.c_str(),
                document.instances.size(), embedding_queries(document.semantics),
                sequence.frames.size());
  return kDone;
}

}  // namespace

Action add_embed(CLI::App& command) {
  auto options = std::make_shared<EmbedOptions>();
  options->mapping.encoder = "default";
  command
      .add_option("MESH", options->mesh,
                  "PLY with an instance id per vertex (property 'label'), or gt: SOURCE's truth")
      ->required();
  add_mapping_options(command, options->mapping);
  command.add_option("--ids", options->ids, "text file with the instance id of each vertex");
  command.add_option("-o,--output", options->map, "map file to write: objects without voxels")
      ->required();
  command.add_flag("--json", options->json, "print one JSON object");
  return [options] { return embed(*options); };
}

}  // namespace ovimap::apps
