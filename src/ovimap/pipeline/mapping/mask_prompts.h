// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "ovimap/frames/frame/registration.h"
#include "ovimap/inference/masks/mask_source.h"
#include "ovimap/segment/depth_segmentation.h"

namespace ovimap {

/// Where a promptable network should look: every region's place in the colour image of
/// `color_camera`.
std::vector<MaskPrompt> region_prompts(const DepthRegions& regions,
                                       const Registration& registration,
                                       const PinholeCamera& color_camera);

}  // namespace ovimap
