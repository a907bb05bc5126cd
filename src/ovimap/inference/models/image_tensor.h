// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <Eigen/Core>

#include "ovimap/image/image.h"
#include "ovimap/inference/models/model_folder.h"
#include "ovimap/inference/models/onnx_session.h"

namespace ovimap {

/// The part of a network's square input that the image fills, at its top left corner. Pixel centres
/// of the image map as x_in_input = (x_in_image + 0.5) * scale - 0.5.
struct InputFrame {
  int width_px = 0, height_px = 0;  ///< of the filled part
  Eigen::Vector2f scale = {1, 1};   ///< input_from_image, per axis
};

/// For ResizeRule::kLongSide and kStretch, which keep the whole image.
InputFrame input_frame(int image_width_px, int image_height_px, const ImageInputSpec& spec);

/// The image resized (antialiased), cut or zero-padded, normalised: 3 * rows * size values, the
/// three channels one after another. At least as many rows as the image fills.
void write_image_tensor(const RgbImage& image, const ImageInputSpec& spec, std::span<float> values);

/// The same as a tensor [1, 3, rows, size], of as many rows as ImageInputSpec::row_step_px asks.
FloatTensor image_tensor(const RgbImage& image, const ImageInputSpec& spec);

}  // namespace ovimap
