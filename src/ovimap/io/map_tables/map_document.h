// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "ovimap/geometry/camera.h"
#include "ovimap/geometry/pose.h"
#include "ovimap/image/codec.h"
#include "ovimap/instance/instance_mesh.h"
#include "ovimap/instance/instance_registry.h"
#include "ovimap/instance/instance_summary.h"
#include "ovimap/instance/object_parts.h"
#include "ovimap/io/map_tables/live_step.h"
#include "ovimap/io/map_tables/map_edit.h"
#include "ovimap/io/map_tables/map_history.h"
#include "ovimap/map/fusion/seen_free.h"
#include "ovimap/map/voxels/voxel_map.h"
#include "ovimap/semantics/views/view_selection.h"

namespace ovimap {

/// One frame that went into a map.
struct FrameLogEntry {
  std::int64_t index = 0;  ///< position in its source
  double timestamp_s = 0;
  std::string name;
  Pose world_from_camera = Pose::Identity();  ///< of the depth camera
  bool labelled = false;                      ///< voted for labels, not only geometry and colour
};

/// What the map knows of its objects' looks.
struct SemanticRecord {
  EncoderIdentity encoder;  ///< whose space the embeddings are in; no name: there are none
  ViewSelectionConfig views;
  CropConfig crops;
  SuperPointLooks looks;
  std::string writing_reader = {};  ///< what read the writing in the crops; empty: nothing did
  RecognizerIdentity recognizer =
      {};  ///< what recognized things in the views; no name: nothing did
};

/// What a map says that no frame changes: where it comes from, and what people told it.
struct MapHeader {
  std::string source = {};                       ///< where the frames came from
  std::string config_text = {};                  ///< effective configuration, "name: value" lines
                                                 ///< (ConfigFields::dump)
  std::map<InstanceId, std::string> names = {};  ///< given by people or queries; none for most
  MapEdits edits = {};  ///< what people corrected, oldest first; the rest is as mapping found it
  MapHistory history = {};  ///< of a map of one visit: that visit, or nothing
};

/// A fused frame as it is kept to be fused again from another pose. Images have the depth camera's
/// size.
struct KeptFrame {
  Bytes depth_png;            ///< 16-bit grey, a quarter of a millimetre each; 0 = invalid
  Bytes color_jpeg;           ///< registered to the depth; black = unknown
  Bytes segments_png;         ///< 16-bit grey; empty: the frame did not vote for labels
  std::vector<Label> labels;  ///< of its segments when it was fused, [id - 1]
};
/// By their place in MapRecord::frames.
using KeptFrames = std::map<std::size_t, std::shared_ptr<const KeptFrame>>;

/// Everything a saved map holds besides its voxels.
struct MapRecord : MapHeader {
  InstanceConfig instance_config;
  InstanceRegistry::State registry;
  std::vector<InstanceSummary> instances;  ///< as summarised when the map was saved
  std::vector<ObjectPart> parts;           ///< of objects, by id, as mapping found them
  InstanceSurfaces surfaces;  ///< of `instances`, thinned: what relations are judged by
  Eigen::Vector3f up = Eigen::Vector3f::UnitZ();  ///< in the world
  std::vector<InstanceSummary> hidden;            ///< corrected maps: objects that people hid
  std::set<InstanceId> locked;  ///< corrected maps: objects that must stay as they are
  SemanticRecord semantics;
  std::vector<FrameLogEntry> frames;  ///< in the order they were fused
  KeptFrames kept_frames;             ///< of those; mostly none
  PinholeCamera depth_camera;
  std::string timings;        ///< of the run, a line "stage p50_ms p95_ms count" each; may be empty
  SeenFree seen_free;         ///< in the last visit: what may come into it moves
  std::vector<Mover> movers;  ///< what moved while it was seen, by id; mostly none
  std::vector<LiveStep> live_steps;  ///< of a live run that made all of the map; else none
  int mask_frames = 0;               ///< frames with 2D masks
  bool unfinished = false;  ///< a checkpoint: `instances`, `surfaces` and `up` are yet to be found
  std::string version;      ///< of the program that wrote the map
  /// VoxelMap::content_hash when it was written; set by load_map, ignored by save_map.
  std::uint64_t content_hash = 0;
};

/// The highest instance id ever given, by mapping or by people.
InstanceId last_instance(const MapRecord& record);

/// What one of the objects or hidden objects of a record looks like; nothing for any other id.
Appearance appearance_of(const MapRecord& record, InstanceId id);

/// A whole saved map.
struct MapDocument : MapRecord {
  VoxelMap map;
};

}  // namespace ovimap
