// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <span>
#include <vector>

#include "ovimap/geometry/mesh.h"
#include "ovimap/instance/instance_summary.h"

namespace ovimap {

/// The map's mesh with instance ids as labels. Only the ids of `instances` occur; other surface has
/// 0.
Mesh extract_instance_mesh(const VoxelMap& map, std::span<const InstanceSummary> instances);

/// Points of each object's surface, world frame, metres.
using InstanceSurfaces = std::map<InstanceId, std::vector<Eigen::Vector3f>>;

/// The mesh's vertices by label, one (the first) from each cube of the edge `spacing_m` that holds
/// some; label 0 is left out. Ordered as the vertices are.
InstanceSurfaces sample_surfaces(const Mesh& mesh, float spacing_m);

}  // namespace ovimap
