// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "ovimap/instance/instance_mesh.h"
#include "ovimap/instance/instance_summary.h"

namespace ovimap {

/// The box around an object, without the specks of surface that have its label here and there: a
/// few voxels behind it, or across the room, would make it as large as the room. The surface is
/// split into pieces, of cubes of two spacings that touch; those count that have at least a fifth
/// of the largest one's points. Several may: what stands before a table hides its middle.
///
/// `surface`: points of it, thinned to one a cube of the edge `spacing_m`, as sample_surfaces has
/// them. Empty where there are none.
Eigen::AlignedBox3f box_without_specks(std::span<const Eigen::Vector3f> surface, float spacing_m);

/// Gives each instance that has a surface that box of it.
void fit_boxes(const InstanceSurfaces& surfaces, float spacing_m,
               std::vector<InstanceSummary>& instances);

/// Samples the surfaces of a map's instances, and fits their boxes to them.
InstanceSurfaces surfaces_and_boxes(const VoxelMap& map, std::vector<InstanceSummary>& instances);

}  // namespace ovimap
