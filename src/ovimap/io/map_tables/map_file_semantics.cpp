// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/map_tables/map_file_semantics.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

#include "ovimap/io/map_tables/map_file_record.h"
#include "ovimap/io/map_tables/map_file_rows.h"
#include "ovimap/io/map_tables/row_words.h"

namespace ovimap {

namespace {

using namespace map_tables;

Bytes float_bytes(const Eigen::VectorXf& values) {
  Bytes bytes;
  for (const float value : values) append_float(bytes, value);
  return bytes;
}

Eigen::VectorXf floats_of(std::span<const std::uint32_t> words) {
  Eigen::VectorXf values(static_cast<Eigen::Index>(words.size()));
  for (std::size_t i = 0; i < words.size(); ++i)
    values[static_cast<Eigen::Index>(i)] = std::bit_cast<float>(words[i]);
  return values;
}

/// An embedding in the encoder's space, or none.
Eigen::VectorXf take_embedding(RowReader& rows, const EncoderIdentity& encoder) {
  const auto words = words_of<std::uint32_t>(rows.blob(), rows);
  if (!words.empty() && encoder.name.empty()) rows.fail("has an embedding of no encoder");
  if (!words.empty() && words.size() != static_cast<std::size_t>(encoder.dimension))
    rows.fail(concat("has an embedding of ", words.size(), " numbers"));
  Eigen::VectorXf embedding = floats_of(words);
  if (!embedding.allFinite()) rows.fail("has an embedding that is not finite");
  return embedding;
}

void insert_look(RowWriter& rows, Label label, const SuperPointLook& look) {
  const auto &low = look.seen_in_world.min(), &high = look.seen_in_world.max();
  rows.insert(label, low.x(), low.y(), low.z(), high.x(), high.y(), high.z(), look.offered,
              look.queries);
}

void insert_view(RowWriter& rows, const ObjectView& view) {
  Bytes bins;
  for (const std::uint64_t word : view.directions.bins.words()) append_word(bins, word);
  const Bytes embedding = float_bytes(view.embedding);
  const Eigen::Vector3f& center = view.directions.center_in_world;
  const auto &low = view.crop.object_px.min(), &high = view.crop.object_px.max();
  const bool crop = !view.crop.empty();
  rows.insert(view.super_point, view.frame, view.visible_px, center.x(), center.y(), center.z(),
              std::span<const std::uint8_t>(bins), std::span<const std::uint8_t>(embedding),
              std::span<const std::uint8_t>(view.crop.image_jpeg),
              std::span<const std::uint8_t>(view.crop.mask_png), crop ? low.x() : 0,
              crop ? low.y() : 0, crop ? high.x() : 0, crop ? high.y() : 0);
}

void write_writing(SQLite::Database& database, const SuperPointLooks& looks) {
  std::optional<RowWriter> rows;  // the table is made for its first line
  for (const auto& [label, look] : looks)
    for (const ObjectView& view : look.views)
      for (std::size_t line = 0; line < view.writing.size(); ++line) {
        if (!rows) rows.emplace(database, kWriting);
        const WrittenLine& read = view.writing[line];
        const auto &low = read.box_px.min(), &high = read.box_px.max();
        rows->insert(view.super_point, view.frame, line, read.text, read.confidence, low.x(),
                     low.y(), high.x(), high.y());
      }
  if (rows) rows->finish();
}

void write_things(SQLite::Database& database, const SemanticRecord& semantics) {
  if (semantics.recognizer.name.empty()) return;
  RowWriter things(database, kThings);
  for (std::size_t i = 0; i < semantics.recognizer.things.size(); ++i)
    things.insert(i, semantics.recognizer.things[i]);
  things.finish();
  RowWriter rows(database, kRecognized);
  for (const auto& [label, look] : semantics.looks)
    for (const ObjectView& view : look.views) {
      if (view.things.size() == 0) continue;
      const Bytes bytes = float_bytes(view.things);
      rows.insert(view.super_point, view.frame, std::span<const std::uint8_t>(bytes));
    }
  rows.finish();
}

constexpr float kPointSteps = 65535.f;
constexpr std::size_t kPointBytes = 6;

using PointSteps = std::vector<std::uint16_t>;  // three of a point, in its box

Eigen::AlignedBox3f box_around(const std::vector<Eigen::Vector3f>& points) {
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& point : points) box.extend(point);
  return box;
}

PointSteps steps_of(const std::vector<Eigen::Vector3f>& points, const Eigen::AlignedBox3f& box) {
  const Eigen::Array3f scale = kPointSteps / box.sizes().array().max(1e-6f);
  PointSteps steps;
  steps.reserve(3 * points.size());
  for (const Eigen::Vector3f& point : points)
    for (const float value : (point - box.min()).array() * scale + 0.5f)
      steps.push_back(static_cast<std::uint16_t>(value));
  return steps;
}

std::vector<Eigen::Vector3f> points_of(const PointSteps& steps, const Eigen::AlignedBox3f& box) {
  const Eigen::Array3f scale = box.sizes().array().max(1e-6f) / kPointSteps;
  std::vector<Eigen::Vector3f> points(steps.size() / 3);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Array3f step(steps[3 * i], steps[3 * i + 1], steps[3 * i + 2]);
    points[i] = box.min() + (step * scale).matrix();
  }
  return points;
}

/// As they are read again.
InstanceSurfaces as_stored(const InstanceSurfaces& surfaces) {
  InstanceSurfaces stored;
  for (const auto& [id, points] : surfaces) {
    const Eigen::AlignedBox3f box = box_around(points);
    stored.emplace_hint(stored.end(), id, points_of(steps_of(points, box), box));
  }
  return stored;
}

ObjectShape take_outline(RowReader& rows) {
  ObjectShape shape;
  for (float* value : {&shape.bottom_m, &shape.top_m, &shape.centroid.x(), &shape.centroid.y(),
                       &shape.centroid.z()})
    *value = static_cast<float>(rows.real());
  const auto words = words_of<std::uint32_t>(rows.blob(), rows);
  std::vector<Eigen::Vector2f> corners(words.size() / 2);
  for (std::size_t i = 0; i < corners.size(); ++i)
    corners[i] = {std::bit_cast<float>(words[2 * i]), std::bit_cast<float>(words[2 * i + 1])};
  const bool finite = std::all_of(corners.begin(), corners.end(),
                                  [](const Eigen::Vector2f& c) { return c.allFinite(); });
  if (words.size() % 2 != 0 || !finite || !shape.centroid.allFinite() ||
      !std::isfinite(shape.height_m()))
    rows.fail("has a shape that is not finite");
  shape.footprint = convex_hull(std::move(corners));
  if (shape.footprint.size() < 3) rows.fail("has a footprint of no size");
  return shape;
}

ObjectMeasures take_measures(RowReader& rows) {
  ObjectMeasures measures;
  for (float* value : {&measures.height_m, &measures.length_m, &measures.depth_m,
                       &measures.bottom_m, &measures.top_share, &measures.covered_share}) {
    *value = static_cast<float>(rows.real());
    if (!std::isfinite(*value)) rows.fail("has a measure that is not finite");
  }
  return measures;
}

}  // namespace

Bytes surface_bytes(const std::vector<Eigen::Vector3f>& points) {
  const Eigen::AlignedBox3f box = box_around(points);
  Bytes bytes;
  append_box(bytes, box);
  for (const std::uint16_t step : steps_of(points, box)) append_word(bytes, step);
  return bytes;
}

std::vector<Eigen::Vector3f> take_surface(RowReader& rows) {
  constexpr float kFurthest_m = 1e5f;  // poses lie within 10 km (pose_fault)
  const std::span<const std::uint8_t> bytes = rows.blob();
  if (bytes.size() <= kBoxBytes || (bytes.size() - kBoxBytes) % kPointBytes != 0)
    rows.fail(concat("has a surface of ", bytes.size(), " bytes"));
  const Eigen::AlignedBox3f box = box_of_words(bytes.first(kBoxBytes), rows);
  if (!((box.min().cwiseAbs().array() <= kFurthest_m).all() &&
        (box.max().cwiseAbs().array() <= kFurthest_m).all()))
    rows.fail("has a surface out of all reach");
  return points_of(words_of<std::uint16_t>(bytes.subspan(kBoxBytes), rows), box);
}

void write_surfaces(SQLite::Database& database, const InstanceSurfaces& surfaces,
                    const MapTable& table) {
  RowWriter rows(database, table);
  for (const auto& [id, points] : surfaces) {
    if (points.empty()) continue;
    const Bytes bytes = surface_bytes(points);
    rows.insert(id, std::span<const std::uint8_t>(bytes));
  }
  rows.finish();
}

InstanceSurfaces read_surfaces(SQLite::Database& database, const MapTable& table) {
  InstanceSurfaces surfaces;
  RowReader rows(database, table);
  while (rows.next()) {
    const auto id = rows.integer<InstanceId>();
    surfaces.emplace(id, take_surface(rows));
  }
  return surfaces;
}

void write_shapes(SQLite::Database& database, const MapRecord& record, const MapTable& table) {
  const std::vector<ObjectShape> shapes =
      shapes_of_instances(record.up, record.instances, as_stored(record.surfaces));
  const std::vector<ObjectMeasures> measures = measure_objects(shapes);
  RowWriter rows(database, table);
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    const ObjectShape& shape = shapes[i];
    const ObjectMeasures& of = measures[i];
    Bytes footprint;
    for (const Eigen::Vector2f& corner : shape.footprint)
      for (const float coordinate : corner) append_float(footprint, coordinate);
    rows.insert(record.instances[i].id, shape.bottom_m, shape.top_m, shape.centroid.x(),
                shape.centroid.y(), shape.centroid.z(), std::span<const std::uint8_t>(footprint),
                of.height_m, of.length_m, of.depth_m, of.bottom_m, of.top_share, of.covered_share);
  }
  rows.finish();
}

ObjectShapes read_shapes(SQLite::Database& database, std::span<const InstanceSummary> instances,
                         const MapTable& table, ObjectShapes::Reader read_whole) {
  std::vector<ObjectShape> outlines;
  std::vector<ObjectMeasures> measures;
  RowReader rows(database, table);
  while (rows.next()) {
    const auto id = rows.integer<InstanceId>();
    if (outlines.size() == instances.size() || instances[outlines.size()].id != id)
      rows.fail(concat("has a shape of ", id, ", which is no object or stands elsewhere"));
    outlines.push_back(take_outline(rows));
    measures.push_back(take_measures(rows));
  }
  if (outlines.size() != instances.size()) rows.fail("lacks the shapes of objects");
  return ObjectShapes(std::move(outlines), std::move(measures), std::move(read_whole));
}

void write_semantics(SQLite::Database& database, const MapRecord& record) {
  RowWriter looks(database, kSuperPointLooks);
  for (const auto& [label, look] : record.semantics.looks) insert_look(looks, label, look);
  looks.finish();
  RowWriter views(database, kSuperPointViews);
  for (const auto& [label, look] : record.semantics.looks)
    for (const ObjectView& view : look.views) insert_view(views, view);
  views.finish();
  write_writing(database, record.semantics.looks);
  write_things(database, record.semantics);
  write_embeddings(database, record.instances, record.semantics, kEmbeddings);
}

void write_embeddings(SQLite::Database& database, std::span<const InstanceSummary> objects,
                      const SemanticRecord& semantics, const MapTable& table) {
  RowWriter embeddings(database, table);
  for (const InstanceSummary& object : objects) {
    const Appearance look = appearance_of(semantics.looks, object.super_points);
    const Eigen::VectorXf fused = fuse_views(look.views, semantics.views.fusion);
    if (fused.size() == 0) continue;
    const Bytes bytes = float_bytes(fused);
    embeddings.insert(object.id, std::span<const std::uint8_t>(bytes));
  }
  embeddings.finish();
}

BinSet take_bins(RowReader& rows, const SphereGrid& grid) {
  auto words = words_of<std::uint64_t>(rows.blob(), rows);
  if (words.empty()) return {};
  const std::size_t count = words.size();
  std::optional<BinSet> bins = BinSet::from_words(std::move(words), grid.bins());
  if (!bins)
    rows.fail(concat("has bins of ", count, " words that do not fit the grid of ", grid.rows, "x",
                     grid.columns, " directions"));
  return std::move(*bins);
}

void take_picture(RowReader& rows, const EncoderIdentity& encoder, ObjectView& view) {
  view.embedding = take_embedding(rows, encoder);
  const std::span<const std::uint8_t> image = rows.blob();
  view.crop.image_jpeg.assign(image.begin(), image.end());
  const std::span<const std::uint8_t> mask = rows.blob();
  view.crop.mask_png.assign(mask.begin(), mask.end());
  Eigen::Vector2i corners[2];
  for (Eigen::Vector2i& corner : corners)
    for (int& coordinate : corner) coordinate = rows.integer<int>();
  if (!view.crop.empty()) view.crop.object_px = {corners[0], corners[1]};
}

std::map<ViewKey, std::vector<WrittenLine>> read_writing(SQLite::Database& database,
                                                         const LabelForest& forest) {
  std::map<ViewKey, std::vector<WrittenLine>> writing;
  if (!holds_table(database, kWriting)) return writing;
  RowReader rows(database, kWriting);
  while (rows.next()) {
    const Label label = take_label(rows, forest);
    std::vector<WrittenLine>& lines = writing[{rows.integer<std::int64_t>(), label}];
    rows.integer<std::int64_t>();  // their order
    WrittenLine line;
    line.text = rows.text();
    line.confidence = static_cast<float>(rows.real());
    if (line.text.empty() || !(line.confidence >= 0.f && line.confidence <= 1.f))
      rows.fail("has a line without text or with a confidence beyond 0 to 1");
    for (Eigen::Vector2i* corner : {&line.box_px.min(), &line.box_px.max()})
      for (int& coordinate : *corner) coordinate = rows.integer<int>();
    lines.push_back(std::move(line));
  }
  return writing;
}

std::vector<std::string> read_things(SQLite::Database& database) {
  std::vector<std::string> things;
  if (!holds_table(database, kThings)) return things;
  RowReader rows(database, kThings);
  while (rows.next()) {
    if (rows.integer<std::size_t>() != things.size()) rows.fail("is out of order");
    things.push_back(rows.text());
    if (things.back().empty()) rows.fail("has no words");
  }
  return things;
}

std::map<ViewKey, Eigen::VectorXf> read_recognized(SQLite::Database& database,
                                                   const LabelForest& forest, std::size_t things) {
  std::map<ViewKey, Eigen::VectorXf> recognized;
  if (!holds_table(database, kRecognized)) return recognized;
  RowReader rows(database, kRecognized);
  while (rows.next()) {
    const Label label = take_label(rows, forest);
    const auto frame = rows.integer<std::int64_t>();
    const auto words = words_of<std::uint32_t>(rows.blob(), rows);
    Eigen::VectorXf ratios = floats_of(words);
    if (words.size() != things || !ratios.allFinite())
      rows.fail(concat("has no ", things, " finite numbers"));
    recognized[{frame, label}] = std::move(ratios);
  }
  return recognized;
}

SuperPointLooks read_looks(SQLite::Database& database, const LabelForest& forest,
                           const SemanticRecord& settings, const PinholeCamera& depth_camera) {
  const SphereGrid grid = settings.views.grid(depth_camera);
  SuperPointLooks result;
  RowReader looks(database, kSuperPointLooks);
  while (looks.next()) {
    SuperPointLook& look = result[take_label(looks, forest)];
    for (Eigen::Vector3f* point : {&look.seen_in_world.min(), &look.seen_in_world.max()})
      for (float& coordinate : *point) coordinate = static_cast<float>(looks.real());
    look.offered = looks.integer<int>();
    look.queries = looks.integer<int>();
  }
  auto writing = read_writing(database, forest);
  auto things = read_recognized(database, forest, settings.recognizer.things.size());
  RowReader views(database, kSuperPointViews);
  while (views.next()) {
    ObjectView view;
    view.super_point = take_label(views, forest);
    view.frame = views.integer<std::int64_t>();
    view.visible_px = views.integer<int>();
    for (float& coordinate : view.directions.center_in_world)
      coordinate = static_cast<float>(views.real());
    view.directions.bins = take_bins(views, grid);
    take_picture(views, settings.encoder, view);
    if (auto lines = writing.extract(view.key())) view.writing = std::move(lines.mapped());
    if (auto ratios = things.extract(view.key())) view.things = std::move(ratios.mapped());
    const auto look = result.find(forest.root(view.super_point));
    if (look == result.end()) views.fail("has a view of a super-point without look");
    insert_view(look->second, std::move(view));
  }
  if (!writing.empty()) throw Error("table writing has a line of no view");
  if (!things.empty()) throw Error("table recognized has a row of no view");
  return result;
}

std::map<InstanceId, Eigen::VectorXf> read_embeddings(SQLite::Database& database,
                                                      const EncoderIdentity& encoder,
                                                      const MapTable& table) {
  std::map<InstanceId, Eigen::VectorXf> result;
  RowReader rows(database, table);
  while (rows.next()) {
    const auto id = rows.integer<InstanceId>();
    result.emplace(id, take_embedding(rows, encoder));
  }
  return result;
}

}  // namespace ovimap
