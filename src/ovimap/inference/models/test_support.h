// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "ovimap/base/error_fixture.h"
#include "ovimap/base/temporary_folder_fixture.h"
#include "ovimap/image/image.h"

namespace ovimap {

/// The committed small models and their expected answers.
inline std::filesystem::path inference_testdata() {
  return std::filesystem::path(OVIMAP_SOURCE_DIR) / "src/ovimap/inference/testdata";
}

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// Paints pixels x0..x1-1, y0..y1-1.
template <class Pixel>
void fill_box(Image<Pixel>& image, int x0, int y0, int x1, int y1, Pixel value) {
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) image.at(x, y) = value;
}

}  // namespace ovimap
