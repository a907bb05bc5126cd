// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "ovimap/synth/shapes/texture.h"

namespace ovimap {

/// A stuffed cushion, thickest in its middle and thin along its rim, in its own frame like a
/// furniture model (front -y, base at z = 0). `size_m`: width, depth, thickness.
TexturedMesh pillow_model(const Eigen::Vector3f& size_m, std::uint64_t seed);

/// A blanket laid flat, its upper side in shallow folds.
TexturedMesh blanket_model(const Eigen::Vector3f& size_m, std::uint64_t seed);

}  // namespace ovimap
