// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>

#include "ovimap/geometry/mesh.h"

namespace ovimap {

/// Adds a mesh to another one.
void append(const Mesh& part, Mesh& mesh);

/// The mesh cut by label. A triangle goes to the label of most of its corners, else to that of its
/// first; each part has the vertices that its triangles need, in their order. Vertices without
/// triangle are in no part.
std::map<std::uint32_t, Mesh> split_by_label(const Mesh& mesh);

/// The mesh without the triangles of the labels for which `drop` is true, and without their
/// vertices.
Mesh without_labels(const Mesh& mesh, const std::function<bool(std::uint32_t)>& drop);

}  // namespace ovimap
