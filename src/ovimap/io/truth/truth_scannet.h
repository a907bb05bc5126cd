// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "ovimap/io/truth/truth.h"

namespace ovimap {

/// SCENE_vh_clean_2.labels.ply (or SCENE_vh_clean_2.ply) in the folder or the one above; empty when
/// there is none. Throws Error when there are several.
std::filesystem::path find_scannet_mesh(const std::filesystem::path& folder);

/// Loads a scene's truth as ScanNet publishes it. Beside the mesh lie
///   SCENE_vh_clean_2.0.010000.segs.json (the segment of each vertex) and
///   SCENE.aggregation.json (the segments and the name of each object);
/// scannetv2-labels.combined.tsv, which numbers the names, lies there or up to three folders above.
/// An object's id is its objectId + 1, as in ScanNet's 2D annotations, since 0 means unlabelled;
/// where objects share a segment, the later one has it. Throws Error naming the file that is
/// missing or broken, and a name that the table lacks.
Truth load_scannet_truth(const std::filesystem::path& mesh, ScanNetClasses classes);

}  // namespace ovimap
