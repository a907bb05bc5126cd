// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/frames/frame/frame.h"
#include "ovimap/inference/models/onnx_session.h"

namespace ovimap {

/// What a finder is told of a frame's depth, [1, kDepthMaps, rows, columns] over its colour image:
/// the logarithm of how many metres wide a pixel is there, plus 5; how steeply the surface falls
/// back to the right and downwards, half of that slope, at most 2; and 1. All are 0 where no depth
/// is known. None of them hangs on how light falls or what a thing is painted like, and the slopes
/// on neither zoom nor scale. `grid_from_image`: its pixels of an image pixel, per axis.
inline constexpr int kDepthMaps = 4;
FloatTensor depth_view(const Frame& frame, const Eigen::Vector2f& grid_from_image, int rows,
                       int columns);

}  // namespace ovimap
