// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "ovimap/geometry/mesh.h"

namespace ovimap {

/// What a scene really looks like.
struct Truth {
  Mesh mesh;                            ///< world frame, metres; without labels
  std::vector<std::int32_t> instances;  ///< id per vertex; 0 or less = unlabelled
  std::vector<std::int32_t> classes;    ///< class per vertex; empty when the source has none
  std::map<std::int32_t, std::string> instance_names, class_names;  ///< empty when none are given
  std::set<std::int32_t> unscored;  ///< instances that the recording calls too small to be scored
};

/// Which of ScanNet's numberings of classes a truth takes.
enum class ScanNetClasses {
  kScanNet200,  ///< raw ids of the 200 classes of the benchmark, 0 for every other
  kNyu40,       ///< 1 to 40, of which the 20 classes of the older benchmark are part
  kRaw,         ///< the ids of all names that annotators used
};

/// Loads the truth that belongs to a recording, of the Replica layout when SCENE_mesh.ply lies
/// beside the folder, else of ScanNet's (io/truth/truth_scannet.h). `source` of the Replica layout
/// is the scene's folder ROOT/SCENE (the one with results/ and traj.txt); the truth lies in ROOT:
///   SCENE_mesh.ply (triangles or quads), instance_labels_SCENE.txt and, when there is one,
///   semantic_labels_SCENE.txt (one whole number per vertex), and for names either labels.json
///   {"instances": {"12": "sofa"}, "classes": {"1": "sofa"}, "unscored": [12]} or the data set's
///   own info_semantic.json.
/// A labels.json in ROOT/SCENE goes before the one in ROOT; info_semantic.json comes last. Labels
/// may also lie in ROOT/replica_gt_instances and ROOT/replica_gt_semantics. Without those of the
/// instances the data set's own mesh_semantic.ply is taken (io/truth/truth_replica.h, which says
/// where). Throws Error naming the file that is missing or broken.
Truth load_truth(const std::filesystem::path& source,
                 ScanNetClasses scannet_classes = ScanNetClasses::kScanNet200);

}  // namespace ovimap
