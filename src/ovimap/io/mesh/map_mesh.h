// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "ovimap/io/map_tables/map_document.h"

namespace ovimap {

/// The map's mesh with the ids of its instances as labels, 0 elsewhere, and without the surface of
/// hidden objects.
Mesh visible_mesh(const MapDocument& document);

/// Calls `visit` with the same mesh part by part, for maps whose mesh, or whose voxels, are more
/// than memory holds. Parts are cut between blocks: vertices there occur in both, with the normals
/// of either part.
void for_each_visible_part(const MapDocument& document,
                           const std::function<void(const Mesh&)>& visit);

}  // namespace ovimap
