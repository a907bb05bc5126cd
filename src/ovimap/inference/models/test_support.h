// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "ovimap/base/error_fixture.h"
#include "ovimap/image/image.h"

namespace ovimap {

/// The committed small models and their expected answers.
inline std::filesystem::path inference_testdata() {
  return std::filesystem::path(OVIMAP_SOURCE_DIR) / "src/ovimap/inference/testdata";
}

/// A folder of its own for one test, removed with it.
class ScratchFolder {
 public:
  explicit ScratchFolder(const std::string& name)
      : path_(std::filesystem::temp_directory_path() /
              ("ovimap_inference_" + name + "_" + std::to_string(::getpid()))) {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~ScratchFolder() { std::filesystem::remove_all(path_); }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

  void write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name) << text;
  }

 private:
  std::filesystem::path path_;
};

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
