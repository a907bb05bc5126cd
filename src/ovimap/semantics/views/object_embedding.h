// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "ovimap/inference/encoders/image_text_encoder.h"
#include "ovimap/semantics/views/object_crop.h"

namespace ovimap {

/// One embedding of length 1 per object: the mean of those of its crop_variants (method section
/// 10). All crops go to the encoder in one batch. Empty where the encoder gave nothing finite.
/// Throws what the encoder throws.
std::vector<Eigen::VectorXf> embed_objects(ImageTextEncoder& encoder,
                                           std::span<const ObjectCrop* const> objects,
                                           const CropConfig& config);

}  // namespace ovimap
