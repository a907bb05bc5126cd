// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

#include <filesystem>

#include "ovimap/image/codec.h"

/// A file of this process alone for readers that take a path; in memory where there is such a
/// place.
inline std::filesystem::path input_file(const char* ending, std::span<const std::uint8_t> bytes) {
  const std::filesystem::path shared = "/dev/shm";
  const auto folder =
      ::access(shared.c_str(), W_OK) == 0 ? shared : std::filesystem::temp_directory_path();
  const auto path = folder / ("ovimap_fuzz_" + std::to_string(::getpid()) + ending);
  ovimap::write_file(path, bytes);
  return path;
}
