// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "ovimap/synth/shapes/texture.h"

namespace ovimap {

/// Appends an upright box whose edges are rounded to `radius_m`, smooth to the eye: cushions,
/// casings. Texture coordinates repeat every `repeat_m`.
void add_rounded_box(TexturedMesh& mesh, const Eigen::Vector3f& low, const Eigen::Vector3f& high,
                     float radius_m, std::uint32_t material, float repeat_m = 1);

/// Appends an upright box with texture coordinates in metres over `repeat_m`, the grain along its
/// longest side.
void add_board(TexturedMesh& mesh, const Eigen::Vector3f& low, const Eigen::Vector3f& high,
               std::uint32_t material, float repeat_m = 1);

/// Appends what a profile of (radius, height) sweeps about the vertical through `base`; the texture
/// goes once round, and once from height 0 to the top.
void add_turned(TexturedMesh& mesh, const Eigen::Vector3f& base,
                std::span<const Eigen::Vector2f> profile, std::uint32_t material);

/// Appends a round bar of that radius along a line of points.
void add_bar(TexturedMesh& mesh, std::span<const Eigen::Vector3f> points, float radius_m,
             std::uint32_t material);

/// The mesh moved and turned; scaled too where the transform is.
TexturedMesh moved(TexturedMesh mesh, const Eigen::Affine3f& target_from_mesh);

}  // namespace ovimap
