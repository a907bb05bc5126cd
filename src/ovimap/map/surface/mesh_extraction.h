// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/geometry/mesh.h"
#include "ovimap/map/voxels/voxel_map.h"

namespace ovimap {

/// Marching-cubes mesh of the whole map: welded across blocks, with normals, colours and the
/// super-point label of each vertex (merges resolved). Equal maps give equal meshes.
Mesh extract_mesh(const VoxelMap& map);

}  // namespace ovimap
