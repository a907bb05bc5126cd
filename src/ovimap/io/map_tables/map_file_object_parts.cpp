// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/map_tables/map_file_object_parts.h"

#include <algorithm>

#include "ovimap/io/map_tables/map_file_rows.h"
#include "ovimap/io/map_tables/map_file_semantics.h"
#include "ovimap/io/map_tables/row_words.h"

namespace ovimap {

namespace {

using map_tables::kObjectParts;
using map_tables::kPartEmbeddings;

ObjectPart take_part(RowReader& rows) {
  ObjectPart part;
  part.id = rows.integer<InstanceId>();
  part.super_points = words_of<Label>(rows.blob(), rows);
  const bool disordered = std::adjacent_find(part.super_points.begin(), part.super_points.end(),
                                             std::greater_equal<>()) != part.super_points.end();
  if (part.super_points.empty() || disordered || part.super_points.front() != part.id)
    rows.fail("has a part that is none");
  for (Eigen::Vector3f* corner : {&part.box.min(), &part.box.max(), &part.centroid})
    for (float& coordinate : *corner) coordinate = static_cast<float>(rows.real());
  part.points = rows.integer<std::size_t>();
  part.views = rows.integer<int>();
  return part;
}

}  // namespace

void write_object_parts(SQLite::Database& database, const MapRecord& record) {
  if (record.parts.empty()) return;
  RowWriter parts(database, kObjectParts);
  for (const ObjectPart& part : record.parts) {
    const Bytes labels = label_bytes(part.super_points);
    const auto &low = part.box.min(), &high = part.box.max(), &center = part.centroid;
    parts.insert(part.id, std::span<const std::uint8_t>(labels), low.x(), low.y(), low.z(),
                 high.x(), high.y(), high.z(), center.x(), center.y(), center.z(), part.points,
                 part.views);
  }
  parts.finish();
  write_embeddings(database, record.parts, record.semantics, kPartEmbeddings);
}

std::vector<ObjectPart> read_object_parts(SQLite::Database& database) {
  std::vector<ObjectPart> parts;
  if (!holds_table(database, kObjectParts)) return parts;
  RowReader rows(database, kObjectParts);
  while (rows.next()) parts.push_back(take_part(rows));
  return parts;
}

std::map<Label, Eigen::VectorXf> read_part_embeddings(SQLite::Database& database,
                                                      const EncoderIdentity& encoder) {
  if (!holds_table(database, kPartEmbeddings)) return {};
  return read_embeddings(database, encoder, kPartEmbeddings);
}

}  // namespace ovimap
