// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/furniture/zip_archive.h"

#include <unzip.h>

#include "ovimap/base/error.h"
#include "ovimap/image/size_limits.h"

namespace ovimap {

struct ZipArchive::Handle {
  explicit Handle(const std::filesystem::path& path) : file(unzOpen64(path.c_str())) {}
  ~Handle() {
    if (file != nullptr) unzClose(file);
  }
  unzFile file;
};

ZipArchive::ZipArchive(const std::filesystem::path& path)
    : path_(path), handle_(std::make_unique<Handle>(path)) {
  if (handle_->file == nullptr)
    throw Error(concat(path.string(), ": missing or no zip file; reinstall what it came with"));
}

ZipArchive::~ZipArchive() = default;
ZipArchive::ZipArchive(ZipArchive&&) noexcept = default;
ZipArchive& ZipArchive::operator=(ZipArchive&&) noexcept = default;

std::optional<Bytes> ZipArchive::read(const std::string& name) const {
  constexpr int kIgnoreCase = 2;
  constexpr std::uint64_t kLargestEntry = std::uint64_t{1} << 30;
  const std::size_t start = name.find_first_not_of('/');
  if (start == std::string::npos) return std::nullopt;
  if (unzLocateFile(handle_->file, name.c_str() + start, kIgnoreCase) != UNZ_OK)
    return std::nullopt;
  unz_file_info64 info{};
  unzGetCurrentFileInfo64(handle_->file, &info, nullptr, 0, nullptr, 0, nullptr, 0);
  // An entry cannot hold more than its file, unpacked, whatever it claims.
  const bool plausible =
      info.uncompressed_size <= kLargestEntry &&
      deflate_can_hold(std::filesystem::file_size(path_), info.uncompressed_size);
  Bytes bytes(plausible ? info.uncompressed_size : 0);
  bool intact = plausible && unzOpenCurrentFile(handle_->file) == UNZ_OK;
  if (intact) {
    const auto length = static_cast<unsigned>(bytes.size());
    intact = unzReadCurrentFile(handle_->file, bytes.data(), length) == static_cast<int>(length);
    intact = unzCloseCurrentFile(handle_->file) == UNZ_OK && intact;
  }
  if (!intact)
    throw Error(
        concat(path_.string(), ": entry ", name, " is damaged; reinstall what it came with"));
  return bytes;
}

}  // namespace ovimap
