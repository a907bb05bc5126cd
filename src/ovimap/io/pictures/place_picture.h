// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/geometry/mesh.h"
#include "ovimap/image/image.h"

namespace ovimap {

/// Where one object is: the mesh from above with that object in red and the rest pale. What is
/// higher than the object is cut away, so that nothing hides it. `mesh`: Mesh::labels are ids of
/// objects. `up`: the world's. Throws Error when nothing of the mesh is that object's.
RgbImage place_picture(Mesh mesh, std::uint32_t id, const Eigen::Vector3f& up);

}  // namespace ovimap
