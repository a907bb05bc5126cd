// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "ovimap/frames/recording/recording.h"

namespace ovimap {

/// One image of a stream.
struct OniImage {
  double time_s = 0;  ///< since the stream's first
  FilePart part;
};

/// What one sensor recorded.
struct OniStream {
  std::string codec;  ///< "16zT", "16zP", "JPEG", "NONE"; empty: there is no such stream
  int width = 0, height = 0;
  double horizontal_fov_rad = 0, vertical_fov_rad = 0;  ///< 0: not in the file
  int pixel_format = 0;                                 ///< OniPixelFormat; 0: not in the file
  bool mirrored = false, cropped = false;
  std::vector<OniImage> images;  ///< in order of time
};

/// A recording of OpenNI's own tools, without its images.
struct OniFile {
  OniStream depth, color;
};

/// Lists what is in a file of OpenNI 1.x or 2.x. One that ends in the middle, as that of a killed
/// recorder does, has what came before. Throws Error naming what is no such file.
OniFile list_oni_file(const std::filesystem::path& path);

}  // namespace ovimap
