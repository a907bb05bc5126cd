// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "ovimap/io/map_tables/map_document.h"

namespace ovimap {

/// The newest file layout this program writes and reads; docs/map-format.md describes it.
inline constexpr int kMapSchema = 7;

/// What a map file tells without its voxels.
struct MapInfo {
  int schema = kMapSchema;
  std::string version, source, config_text, timings;  ///< as in MapRecord
  std::int64_t frames = 0;
  int mask_frames = 0;
  bool unfinished = false;                 ///< a checkpoint of a run: without instances
  std::vector<InstanceSummary> instances;  ///< as people corrected them
  std::vector<InstanceSummary> hidden;     ///< objects that people hid; not in `instances`
  std::set<InstanceId> locked;             ///< objects that must stay as they are
  std::vector<ObjectPart> parts;           ///< of objects, by id; parts_by_object() says of which
  std::map<InstanceId, std::string> names;
  std::string writing_reader;  ///< what read the writing; empty: nothing did
  std::map<InstanceId, std::vector<WrittenLine>> writing;  ///< of those on which some was read
  RecognizerIdentity recognizer;                  ///< what recognized things; no name: nothing did
  std::map<InstanceId, Eigen::VectorXf> things;   ///< things_of() the objects that it looked at
  MapHistory history;                             ///< empty in maps of earlier schemas
  EncoderIdentity encoder;                        ///< of the embeddings; no name: there are none
  Eigen::Vector3f up = Eigen::Vector3f::UnitZ();  ///< in the world
  PinholeCamera depth_camera;
  float voxel_size_m = 0;
  std::uint64_t blocks = 0;
  std::uint64_t size_bytes = 0;
  std::uint64_t content_hash = 0;
};

/// Writes a map as one file. It is built beside `path` and takes its place only when complete and
/// on disk: on any failure a map that was there stays as it was and nothing is left behind. The
/// same map gives the same bytes. Throws Error naming the path, the reason and the remedy.
void save_map(const std::filesystem::path& path, const VoxelMap& map, const MapRecord& record);
void save_map(const std::filesystem::path& path, const MapDocument& document);

/// Throws what save_map would throw for a target that cannot be written (missing folder, a folder
/// itself, no permission), so that a long run learns of it before it starts, and refuses names that
/// say that the file is something else ("room.ply"). Changes nothing.
void check_map_target(const std::filesystem::path& path);

/// Reads a whole map as mapping found it, with the log of corrections (map_edits.h has the
/// corrected one), and verifies every part of it against its stored hash. Throws Error when the
/// file is missing, no ovimap map, of a newer schema, or damaged; never returns altered content.
MapDocument load_map(const std::filesystem::path& path);

/// The same but for the voxels: the blocks are there, but not in memory. Before one is asked for,
/// the map must be given a store that has them (VoxelMap::keep_in).
MapDocument load_map_without_voxels(const std::filesystem::path& path);

/// Reads what needs no voxels (milliseconds), verified likewise; a damaged voxel goes unnoticed
/// here.
MapInfo read_map_info(const std::filesystem::path& path);

/// What tells a map from others, and from itself before a change.
struct MapIdentity {
  std::string source;
  std::int64_t frames = 0;
  bool unfinished = false;         ///< a checkpoint of a run
  std::uint64_t content_hash = 0;  ///< of the voxels
  EncoderIdentity encoder;         ///< of the embeddings; no name: there are none
  std::uint64_t revision = 0;      ///< another after any change but that of `meta` alone
};

/// Reads it from the tables `meta`, verified, and `checks`.
MapIdentity read_map_identity(const std::filesystem::path& path);

}  // namespace ovimap
