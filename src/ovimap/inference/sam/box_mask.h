// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

#include "ovimap/image/image.h"
#include "ovimap/inference/sam/sam_network.h"

namespace ovimap {

/// What the network takes for the thing in a box: of its proposals the one that it believes in
/// most, of the image's size, 1 inside. `features`: of that image; `box_px`: pixel centres at
/// integers. Throws Error when the decoder fails.
Image<std::uint8_t> mask_in_box(const SamNetwork& network, const ImageFeatures& features,
                                const Eigen::AlignedBox2f& box_px, int width, int height);

}  // namespace ovimap
