// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "ovimap/geometry/camera.h"
#include "ovimap/geometry/mesh.h"
#include "ovimap/geometry/pose.h"
#include "ovimap/synth/render/ray_scene.h"
#include "ovimap/synth/rooms/room.h"

namespace ovimap {

class ConfigFields;

struct TruthMeshConfig {
  float longest_edge_m = 0.025f;   ///< longer edges are halved until they are not
  float merge_cell_m = 0.01f;      ///< vertices of one instance in one cell of this size become one
  float leave_surface_m = 0.003f;  ///< how far before a vertex the line of sight may end
};
void list_fields(TruthMeshConfig& config, ConfigFields& fields);

/// All surfaces of the room as triangles of about even size, with the instance id (label), colour
/// and normal of each vertex.
Mesh surface_mesh(const SynthRoom& room, const TruthMeshConfig& config = {});

/// The vertices that at least one camera pose sees from up to 16 m, with the triangles between
/// them: what a mapper that watched these frames could know.
Mesh seen_part(const Mesh& mesh, const RayScene& scene, const PinholeCamera& camera,
               std::span<const Pose> world_from_camera, const TruthMeshConfig& config = {});

}  // namespace ovimap
