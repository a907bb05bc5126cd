// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/map_file/searchable_map.h"

#include <utility>

#include "ovimap/io/corrections/map_file_corrections.h"
#include "ovimap/io/map_file/map_file_access.h"
#include "ovimap/io/map_file/map_file_parts.h"
#include "ovimap/io/map_tables/map_file_frames.h"
#include "ovimap/io/map_tables/map_file_object_parts.h"
#include "ovimap/io/map_tables/map_file_rows.h"
#include "ovimap/io/map_tables/map_file_semantics.h"

namespace ovimap {

namespace {

/// A row for each of these objects; zeros where none is known.
Embeddings rows_of(const std::map<InstanceId, Eigen::VectorXf>& known,
                   std::span<const InstanceSummary> objects, int dimension) {
  Embeddings rows = Embeddings::Zero(static_cast<Eigen::Index>(objects.size()), dimension);
  for (std::size_t i = 0; i < objects.size(); ++i)
    if (const auto found = known.find(objects[i].id);
        found != known.end() && found->second.size() > 0)
      rows.row(static_cast<Eigen::Index>(i)) = found->second;
  return rows;
}

/// Of the instances as people corrected them; none before the schema that has them.
InstanceSurfaces surfaces_in(SQLite::Database& database, int schema) {
  if (schema < kSchemaWithSemantics) return {};
  return read_surfaces(
      database, has_corrections(database) ? map_tables::kCorrectedSurfaces : map_tables::kSurfaces);
}

/// Those of an older program's map are found from its surfaces.
ObjectShapes shapes_in(SQLite::Database& database, const std::filesystem::path& path,
                       const MapInfo& info) {
  const bool corrected = has_corrections(database);
  const MapTable& table = corrected ? map_tables::kCorrectedShapes : map_tables::kObjectShapes;
  if (!holds_table(database, table))
    return ObjectShapes(
        shapes_of_instances(info.up, info.instances, surfaces_in(database, info.schema)));
  return read_shapes(database, info.instances, table,
                     [path, up = info.up, instances = info.instances] {
                       return shapes_of_instances(up, instances, read_corrected_surfaces(path));
                     });
}

}  // namespace

InstanceSurfaces read_corrected_surfaces(const std::filesystem::path& path) {
  OpenMap file(path);
  InstanceSurfaces surfaces;
  file.read([&](SQLite::Database& database) { surfaces = surfaces_in(database, file.schema()); });
  return surfaces;
}

MapSightings read_sightings(const std::filesystem::path& path) {
  OpenMap file(path);
  MapSightings seen;
  file.read([&](SQLite::Database& database) {
    MapRecord record;
    read_frames(database, record);
    seen.frames = std::move(record.frames);
    if (file.schema() >= kSchemaWithSuperPoints) seen.last = read_last_frames(database);
  });
  return seen;
}

SearchableMap read_searchable_map(const std::filesystem::path& path) {
  OpenMap file(path);
  SearchableMap map;
  file.read([&](SQLite::Database& database) {
    map.info = read_info(database, file);
    std::map<InstanceId, Eigen::VectorXf> embeddings, of_parts;
    if (file.schema() >= kSchemaWithSemantics) {
      embeddings = read_embeddings(
          database, map.info.encoder,
          has_corrections(database) ? map_tables::kCorrectedEmbeddings : map_tables::kEmbeddings);
      of_parts = read_part_embeddings(database, map.info.encoder);
    }
    map.shapes = shapes_in(database, path, map.info);
    MapRecord record;
    read_frames(database, record);
    map.frames = std::move(record.frames);
    const int dimension = map.info.encoder.dimension;
    map.embeddings = rows_of(embeddings, map.info.instances, dimension);
    map.part_embeddings = rows_of(of_parts, map.info.parts, dimension);
  });
  return map;
}

}  // namespace ovimap
