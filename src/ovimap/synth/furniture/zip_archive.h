// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "ovimap/image/codec.h"

namespace ovimap {

/// A zip file opened for reading. Not thread-safe.
class ZipArchive {
 public:
  /// Throws Error when the file is missing or no zip file.
  explicit ZipArchive(const std::filesystem::path& path);
  ~ZipArchive();
  ZipArchive(ZipArchive&&) noexcept;
  ZipArchive& operator=(ZipArchive&&) noexcept;

  const std::filesystem::path& path() const { return path_; }

  /// Whether there is such an entry, named as for read().
  bool contains(const std::string& name) const;

  /// The bytes of an entry (a leading slash in `name` is ignored; upper and lower case are alike,
  /// as models name their textures carelessly), or nothing when there is no such entry. Throws
  /// Error when the entry is damaged.
  [[nodiscard]] std::optional<Bytes> read(const std::string& name) const;

 private:
  struct Handle;
  std::filesystem::path path_;
  std::unique_ptr<Handle> handle_;
};

}  // namespace ovimap
