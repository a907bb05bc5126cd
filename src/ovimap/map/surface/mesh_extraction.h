// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/geometry/mesh.h"
#include "ovimap/map/voxels/voxel_map.h"

namespace ovimap {

/// Marching-cubes mesh of the whole map: welded across blocks, with normals, colours and the
/// super-point label of each vertex (merges resolved). Equal maps give equal meshes.
Mesh extract_mesh(const VoxelMap& map);

/// Gives each vertex the mean normal of the triangles around it, weighed by their areas.
void add_normals(Mesh& mesh);

}  // namespace ovimap
