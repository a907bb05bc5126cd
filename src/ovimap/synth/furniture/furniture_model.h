// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/synth/furniture/furniture_catalog.h"
#include "ovimap/synth/shapes/texture.h"

namespace ovimap {

/// Loads a model of the catalogue at its catalogue size in its own frame: metres, x along the
/// width, z up, its front facing -y, the middle of its base at the origin. The parts of a model
/// become one mesh. Surfaces that are nearly clear (glass) are left out: neither colour nor depth
/// sees them. Missing textures fall back to the material's colour. Throws Error naming the archive
/// and the model when it cannot be read.
TexturedMesh load_furniture_model(const FurnitureEntry& entry);

}  // namespace ovimap
