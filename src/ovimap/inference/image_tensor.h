// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "ovimap/image/image.h"
#include "ovimap/inference/model_folder.h"
#include "ovimap/inference/onnx_session.h"

namespace ovimap {

/// The part of a network's square input that the image fills, at its top left corner. Pixel centres
/// of the image map as x_in_input = (x_in_image + 0.5) * scale - 0.5.
struct InputFrame {
  int width_px = 0, height_px = 0;  ///< of the filled part
  Eigen::Vector2f scale = {1, 1};   ///< input_from_image, per axis
};

InputFrame input_frame(int image_width_px, int image_height_px, const ImageInputSpec& spec);

/// The image resized (bilinear with antialiasing), normalised and zero-padded to [1, 3, size,
/// size].
FloatTensor image_tensor(const RgbImage& image, const ImageInputSpec& spec);

}  // namespace ovimap
