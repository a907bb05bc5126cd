// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

#include "ovimap/geometry/mesh.h"
#include "ovimap/map/voxels/voxel_map.h"

namespace ovimap {

/// Marching-cubes mesh of the whole map: welded across blocks, with normals, colours and the
/// super-point label of each vertex (merges resolved). Equal maps give equal meshes.
Mesh extract_mesh(const VoxelMap& map);

/// Calls `visit` with the same mesh in parts of some `triangles`, for maps whose mesh, or whose
/// voxels, are more than memory holds. Parts are cut between blocks: vertices there occur in both,
/// with the normals of either part. `visit` may change the part.
void for_each_mesh_part(const VoxelMap& map, std::size_t triangles,
                        const std::function<void(Mesh&)>& visit);

/// Gives each vertex the mean normal of the triangles around it, weighed by their areas.
void add_normals(Mesh& mesh);

}  // namespace ovimap
