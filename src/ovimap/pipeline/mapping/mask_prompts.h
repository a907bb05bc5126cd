// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "ovimap/frames/frame/registration.h"
#include "ovimap/inference/masks/mask_source.h"
#include "ovimap/instance/instance_registry.h"
#include "ovimap/segment/depth_segmentation.h"

namespace ovimap {

/// Where a promptable network should look: every region's place in the colour image of
/// `color_camera`.
std::vector<MaskPrompt> region_prompts(const DepthRegions& regions,
                                       const Registration& registration,
                                       const PinholeCamera& color_camera);

/// The same for the objects of a map in sight, as known ones. `instances`: of each depth pixel, the
/// map seen from the frame's depth camera, 0 = none.
std::vector<MaskPrompt> object_prompts(const Image<InstanceId>& instances,
                                       const Registration& registration,
                                       const PinholeCamera& color_camera);

}  // namespace ovimap
