// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/map_tables/map_file_meta.h"

#include <charconv>
#include <limits>
#include <map>

#include "ovimap/base/config.h"
#include "ovimap/geometry/camera_limits.h"
#include "ovimap/io/map_tables/map_file_rows.h"

namespace ovimap {

namespace {

using namespace map_tables;

/// Every plain value of a map by its key in the table `meta`. Written and read through this one
/// list; a key that a file lacks keeps its default.
void list_meta(MapRecord& record, VoxelMapConfig& map_config, ConfigFields& fields) {
  constexpr int kMostPixels = 1 << 20;
  fields.add("version", record.version, "of the program that wrote the map");
  fields.add("source", record.source, "where the frames came from");
  fields.add("config", record.config_text, "effective configuration");
  fields.add("timings", record.timings, "how long the stages of a frame took");
  fields.add("mask_frames", record.mask_frames, 0, std::numeric_limits<int>::max(),
             "frames with 2D masks");
  fields.add("entity_frames", record.registry.entity_frames, 0, std::numeric_limits<int>::max(),
             "frames that entity_sightings counts");
  fields.add("registry_frames", record.registry.frames, 0, std::numeric_limits<int>::max(),
             "frames that super_point_frames counts");
  fields.add("unfinished", record.unfinished, "the map is a checkpoint of a run");
  fields.group("up", [&](ConfigFields& up) {
    up.add("x", record.up.x(), -1.f, 1.f, "away from the ground, in the world");
    up.add("y", record.up.y(), -1.f, 1.f, "away from the ground, in the world");
    up.add("z", record.up.z(), -1.f, 1.f, "away from the ground, in the world");
  });
  fields.group("depth_camera", [&](ConfigFields& camera) {
    camera.add("width", record.depth_camera.width, 0, kMostPixels, "pixels");
    camera.add("height", record.depth_camera.height, 0, kMostPixels, "pixels");
    camera.add("fx", record.depth_camera.fx, 0.f, kMostFocal_px, "pixels");
    camera.add("fy", record.depth_camera.fy, 0.f, kMostFocal_px, "pixels");
    camera.add("cx", record.depth_camera.cx, -kMostFocal_px, kMostFocal_px, "pixels");
    camera.add("cy", record.depth_camera.cy, -kMostFocal_px, kMostFocal_px, "pixels");
  });
  fields.group("encoder", [&](ConfigFields& encoder) {
    constexpr int kMostDimensions = 1 << 16;
    encoder.add("name", record.semantics.encoder.name, "model whose embeddings these are");
    encoder.add("dimension", record.semantics.encoder.dimension, 0, kMostDimensions,
                "numbers of an embedding");
    encoder.add("digest", record.semantics.encoder.digest, "SHA-256 over the model's files");
  });
  fields.group("writing", [&](ConfigFields& writing) {
    writing.add("reader", record.semantics.writing_reader, "model that read what is written");
  });
  fields.group("recognizer", [&](ConfigFields& recognizer) {
    recognizer.add("name", record.semantics.recognizer.name, "models that recognized things");
  });
  fields.group("views", [&](ConfigFields& views) { list_fields(record.semantics.views, views); });
  fields.group("crops", [&](ConfigFields& crops) { list_fields(record.semantics.crops, crops); });
  fields.group("map", [&](ConfigFields& map) { list_fields(map_config, map); });
  fields.group("instance",
               [&](ConfigFields& instance) { list_fields(record.instance_config, instance); });
}

std::uint64_t parse_number(const std::map<std::string, std::string>& meta, const std::string& key,
                           int base, std::uint64_t max) {
  const auto found = meta.find(key);
  if (found == meta.end()) throw Error(concat("table meta has no ", key));
  const std::string& text = found->second;
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, base);
  if (error != std::errc() || end != text.data() + text.size() || value > max)
    throw Error(concat("table meta has no usable ", key));
  return value;
}

}  // namespace

std::string hash_text(std::uint64_t hash) {
  std::string text(16, '0');
  for (auto digit = text.rbegin(); digit != text.rend(); ++digit, hash >>= 4)
    *digit = "0123456789abcdef"[hash & 15];
  return text;
}

void write_meta(SQLite::Database& database, const MapRecord& record, const MapMeta& meta) {
  MapRecord plain;
  plain.version = record.version;
  plain.source = record.source;
  plain.config_text = record.config_text;
  plain.timings = record.timings;
  plain.mask_frames = record.mask_frames;
  plain.registry.entity_frames = record.registry.entity_frames;
  plain.registry.frames = record.registry.frames;
  plain.unfinished = record.unfinished;
  plain.up = record.up;
  plain.depth_camera = record.depth_camera;
  plain.instance_config = record.instance_config;
  plain.semantics.encoder = record.semantics.encoder;
  plain.semantics.writing_reader = record.semantics.writing_reader;
  plain.semantics.recognizer.name = record.semantics.recognizer.name;
  plain.semantics.views = record.semantics.views;
  plain.semantics.crops = record.semantics.crops;
  VoxelMapConfig map_config = meta.map_config;
  ConfigFields fields;
  list_meta(plain, map_config, fields);
  RowWriter rows(database, kMeta);
  for (const ConfigField& field : fields.fields()) {
    const std::string text = field.get();
    field.set(text);  // what cannot be read again must not be written
    rows.insert(field.name, text);
  }
  rows.insert(std::string("frames"), std::to_string(meta.frames));
  rows.insert(std::string("blocks"), std::to_string(meta.blocks));
  rows.insert(std::string("last_instance_id"), std::to_string(record.registry.last_id));
  rows.insert(std::string("content_hash"), hash_text(meta.content_hash));
  rows.finish();
}

MapMeta read_meta(SQLite::Database& database, MapRecord& record) {
  std::map<std::string, std::string> texts;
  RowReader rows(database, kMeta);
  while (rows.next()) {
    std::string key = rows.text();
    texts[std::move(key)] = rows.text();
  }
  MapMeta meta;
  ConfigFields fields;
  list_meta(record, meta.map_config, fields);
  for (const ConfigField& field : fields.fields())
    if (const auto found = texts.find(field.name); found != texts.end()) field.set(found->second);
  constexpr auto kMost = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  // Two maps can become one, whose objects can be split.
  constexpr std::uint64_t kMostInstances = std::numeric_limits<InstanceId>::max() / 4;
  meta.frames = static_cast<std::int64_t>(parse_number(texts, "frames", 10, kMost));
  meta.blocks = parse_number(texts, "blocks", 10, kMost);
  record.registry.last_id =
      static_cast<InstanceId>(parse_number(texts, "last_instance_id", 10, kMostInstances));
  meta.content_hash =
      parse_number(texts, "content_hash", 16, std::numeric_limits<std::uint64_t>::max());
  record.content_hash = meta.content_hash;
  meta.unfinished = record.unfinished;
  return meta;
}

}  // namespace ovimap
