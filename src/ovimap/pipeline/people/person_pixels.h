// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <Eigen/Geometry>

#include "ovimap/frames/frame/frame.h"
#include "ovimap/pipeline/people/people_config.h"

namespace ovimap {

/// 1 where a pixel is somebody's.
using PeopleMask = Image<std::uint8_t>;

/// Where each depth pixel lies in the colour image, as an index into it, whether or not something
/// hides it there; -1 where it has no depth or lies outside. Of the depth's size.
Image<std::int32_t> color_places(const Frame& frame);

/// The pixels of the colour image that may be of the person in a box, told by depth alone: all in
/// the box but those whose depth says that they are of something else. The body is what hangs
/// together with the surface in the middle of the box. `places`: color_places of the frame.
PeopleMask pixels_by_depth(const Frame& frame, const Image<std::int32_t>& places,
                           const Eigen::AlignedBox2f& box_px, const PeopleConfig& config);

/// The mask with all pixels at most `radius_px` beside and above, in a square.
PeopleMask grown(const PeopleMask& mask, int radius_px);

/// The box around what a mask holds; empty where it holds nothing.
Eigen::AlignedBox2f extent_of(const PeopleMask& mask);

}  // namespace ovimap
