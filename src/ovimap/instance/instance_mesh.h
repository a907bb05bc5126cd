// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "ovimap/geometry/mesh.h"
#include "ovimap/instance/instance_summary.h"

namespace ovimap {

/// The map's mesh with instance ids as labels. Only the ids of `instances` occur; other surface has
/// 0.
Mesh extract_instance_mesh(const VoxelMap& map, std::span<const InstanceSummary> instances);

}  // namespace ovimap
