// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "ovimap/synth/shapes/oriented_box.h"
#include "ovimap/synth/shapes/texture.h"

namespace ovimap {

/// Appends a material and returns its index.
std::uint32_t add_material(TexturedMesh& mesh, SurfaceMaterial material);

/// Appends the parallelogram corner + a * u + b * v (0 <= a, b <= 1), texture coordinates running
/// from `uv_low` at the corner to `uv_high` opposite it. Its normal is u x v.
void add_panel(TexturedMesh& mesh, const Eigen::Vector3f& corner, const Eigen::Vector3f& u,
               const Eigen::Vector3f& v, std::uint32_t material,
               const Eigen::Vector2f& uv_low = Eigen::Vector2f::Zero(),
               const Eigen::Vector2f& uv_high = Eigen::Vector2f::Ones());

/// Appends the six sides of an upright box.
void add_box(TexturedMesh& mesh, const Eigen::Vector3f& low, const Eigen::Vector3f& high,
             std::uint32_t material);

/// Appends all of `part`.
void add_mesh(TexturedMesh& mesh, const TexturedMesh& part);

/// Stretches a model (its base centred at the origin) to another size and puts it where `box` is.
TexturedMesh placed_mesh(const TexturedMesh& model, const OrientedBox& box);

Eigen::AlignedBox3f bounds(const TexturedMesh& mesh);

/// What most of the surface is made of; empty where that is not said.
std::string main_substance(const TexturedMesh& mesh);

}  // namespace ovimap
