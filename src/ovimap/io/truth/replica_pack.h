// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "ovimap/frames/frame/frame_source.h"
#include "ovimap/geometry/mesh.h"

namespace ovimap {

class ConfigFields;

struct ReplicaPackConfig {
  int jpeg_quality = 92;
  float depth_units_per_m = 6553.5f;  ///< 16-bit depth images reach 10 m
};
void list_fields(ReplicaPackConfig& config, ConfigFields& fields);

/// What a scene's labels mean.
struct PackInstance {
  std::uint32_t id = 0, class_id = 0;
  std::string class_name;
  std::string room = {};       ///< which room it is in; empty: not said
  std::string substance = {};  ///< what most of it is made of; empty: not said
};

/// A recording and its truth, as they go to disk.
struct ReplicaPack {
  std::string scene;  ///< the folder's name
  const FrameSource* frames =
      nullptr;  ///< registered, one camera for all; with true ids or without
  Mesh truth;   ///< labels are instance ids; may be empty
  std::vector<PackInstance> instances;
  std::vector<std::uint32_t> unscored;  ///< ids too small or too little seen to be scored
  bool timed = false;                   ///< frames have true times: writes timestamps.txt
  std::string notice;                   ///< who made what is shown (Markdown); empty: no NOTICE.md
  std::string settings;                 ///< how it was made (YAML); empty: no settings.yaml
};

/// `done` of `total` frames are on disk.
using PackProgress = std::function<void(std::int64_t done, std::int64_t total)>;

/// Writes a scene in the layout of NICE-SLAM's Replica pack, so that open_frame_source and
/// load_truth read it: ROOT/cam_params.json; ROOT/SCENE/traj.txt, timestamps.txt (seconds, a line a
/// frame), labels.json, NOTICE.md and settings.yaml; ROOT/SCENE/results/{frame%06d.jpg,
/// depth%06d.png, instance%06d.png}; ROOT/SCENE_mesh.ply;
/// ROOT/{instance,semantic}_labels_SCENE.txt. Frames that are there already are left alone, so a
/// broken-off run goes on where it stopped; every file appears only when complete. Throws Error
/// when a frame cannot be read or is not registered, when what is there already has another camera
/// or was made with other settings, or when a file cannot be written.
void write_replica_pack(const std::filesystem::path& root, const ReplicaPack& pack,
                        const ReplicaPackConfig& config = {}, const PackProgress& progress = {});

}  // namespace ovimap
