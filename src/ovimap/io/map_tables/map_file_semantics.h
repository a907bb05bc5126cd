// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>

#include "ovimap/io/map_tables/map_document.h"
#include "ovimap/io/map_tables/map_file_rows.h"
#include "ovimap/semantics/relations/object_shapes.h"

namespace SQLite {
class Database;
}

namespace ovimap {

/// Writes the looks of super-points: their views and crops, and for each instance that has one its
/// fused embedding, so that a search reads nothing else.
void write_semantics(SQLite::Database& database, const MapRecord& record);

/// The way back, without the fused embeddings. Throws Error with a phrase when the file does not
/// hold what was written, or what does not fit the encoder and the grid of `settings`.
SuperPointLooks read_looks(SQLite::Database& database, const LabelForest& forest,
                           const SemanticRecord& settings, const PinholeCamera& depth_camera);

/// What was read in the views; nothing in most maps.
std::map<ViewKey, std::vector<WrittenLine>> read_writing(SQLite::Database& database,
                                                         const LabelForest& forest);

/// What a recognizer tells, and its log ratios [things] by view; nothing in maps made without one.
std::vector<std::string> read_things(SQLite::Database& database);
std::map<ViewKey, Eigen::VectorXf> read_recognized(SQLite::Database& database,
                                                   const LabelForest& forest, std::size_t things);

/// The last columns of a row of views.
void take_picture(RowReader& rows, const EncoderIdentity& encoder, ObjectView& view);
/// Directions that were seen: none, or of the map's own grid.
BinSet take_bins(RowReader& rows, const SphereGrid& grid);

/// The fused embeddings by instance.
std::map<InstanceId, Eigen::VectorXf> read_embeddings(SQLite::Database& database,
                                                      const EncoderIdentity& encoder,
                                                      const MapTable& table);
/// Of each of these objects, or parts of objects, its views' embeddings, fused.
void write_embeddings(SQLite::Database& database, std::span<const InstanceSummary> objects,
                      const SemanticRecord& semantics, const MapTable& table);

/// Points of a surface, at least one: their box, then each in steps of 1/65535 of it.
Bytes surface_bytes(const std::vector<Eigen::Vector3f>& points);
std::vector<Eigen::Vector3f> take_surface(RowReader& rows);

/// Points of the objects' surfaces.
void write_surfaces(SQLite::Database& database, const InstanceSurfaces& surfaces,
                    const MapTable& table);
InstanceSurfaces read_surfaces(SQLite::Database& database, const MapTable& table);

/// What the objects' surfaces measure as they are stored, or their boxes where they have none.
void write_shapes(SQLite::Database& database, const MapRecord& record, const MapTable& table);
/// `read_whole`: see ObjectShapes. Throws Error with a phrase unless they are of these instances.
ObjectShapes read_shapes(SQLite::Database& database, std::span<const InstanceSummary> instances,
                         const MapTable& table, ObjectShapes::Reader read_whole);

}  // namespace ovimap
