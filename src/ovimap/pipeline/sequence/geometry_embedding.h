// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "ovimap/frames/frame/frame_source.h"
#include "ovimap/geometry/mesh.h"
#include "ovimap/pipeline/mapping/appearance_builder.h"
#include "ovimap/pipeline/sequence/sequence_run.h"

namespace ovimap {

struct GeometryEmbeddingConfig {
  SemanticsConfig semantics;
  float occlusion_margin_m = 0.1f;  ///< measured depth this much nearer hides the mesh
  float near_m = 0.05f;             ///< what lies nearer to the camera is cut away
};

/// Embeddings for objects of finished geometry: a mesh with an instance id per vertex
/// (Mesh::labels, 0 = none) and the frames that saw it, by the same choice of views as while
/// mapping (what OpenMask3D does; the ground-truth rows of the paper's view ablation). The result
/// is a map without voxels that can be searched. Bad frames are skipped and listed in `sequence`.
/// Throws Error when the mesh has no triangles or no labels, or no frame is usable, and what the
/// encoder throws.
MapDocument embed_geometry(const Mesh& mesh, const FrameSource& source,
                           const std::vector<std::int64_t>& positions,
                           const GeometryEmbeddingConfig& config,
                           std::shared_ptr<ImageTextEncoder> encoder, SequenceResult& sequence,
                           const SequenceProgress& progress = nullptr,
                           std::shared_ptr<const ThingRecognizer> recognizer = nullptr);

/// The mesh's objects: box, centroid and number of their vertices, ordered by id.
std::vector<InstanceSummary> summarize_mesh(const Mesh& mesh);

}  // namespace ovimap
