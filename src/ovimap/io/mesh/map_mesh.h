// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>

#include "ovimap/io/map_tables/map_document.h"

namespace ovimap {

/// The map's mesh with the ids of its instances as labels, 0 elsewhere, and without the surface of
/// hidden objects.
Mesh visible_mesh(const MapDocument& document);

/// Calls `visit` with the same mesh in parts of some two million triangles, for maps whose mesh, or
/// whose voxels, are more than memory holds: cut as for_each_mesh_part does. `visit` may change the
/// part.
void for_each_visible_part(const MapDocument& document, const std::function<void(Mesh&)>& visit);

/// The same as a mesh in parts, each changed by `change`; it refers to the document. Calling it
/// throws Error, naming the file `map`, where there is no surface: in maps that `ovimap embed`
/// makes.
MeshParts visible_parts(
    const MapDocument& document, const std::filesystem::path& map,
    std::function<void(Mesh&)> change = [](Mesh&) {});

}  // namespace ovimap
