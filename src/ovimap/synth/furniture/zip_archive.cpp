// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/furniture/zip_archive.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <unordered_map>

#include <unzip.h>

#include "ovimap/base/error.h"
#include "ovimap/image/size_limits.h"

namespace ovimap {

namespace {

std::string key_of(const std::string& name) {
  std::string key = name.substr(std::min(name.find_first_not_of('/'), name.size()));
  std::transform(key.begin(), key.end(), key.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return key;
}

}  // namespace

struct ZipArchive::Handle {
  explicit Handle(const std::filesystem::path& path) : file(unzOpen64(path.c_str())) {
    if (file == nullptr) return;
    // Found by name, an entry would be searched for from the first one on, in the file.
    std::array<char, 4096> name{};
    for (int more = unzGoToFirstFile(file); more == UNZ_OK; more = unzGoToNextFile(file)) {
      unz64_file_pos place{};
      if (unzGetCurrentFileInfo64(file, nullptr, name.data(), name.size() - 1, nullptr, 0, nullptr,
                                  0) == UNZ_OK &&
          unzGetFilePos64(file, &place) == UNZ_OK)
        entries.emplace(key_of(name.data()), place);
    }
  }
  ~Handle() {
    if (file != nullptr) unzClose(file);
  }
  unzFile file;
  std::unordered_map<std::string, unz64_file_pos> entries;  // by key_of
};

ZipArchive::ZipArchive(const std::filesystem::path& path)
    : path_(path), handle_(std::make_unique<Handle>(path)) {
  if (handle_->file == nullptr)
    throw Error(concat(path.string(), ": missing or no zip file; reinstall what it came with"));
}

ZipArchive::~ZipArchive() = default;
ZipArchive::ZipArchive(ZipArchive&&) noexcept = default;
ZipArchive& ZipArchive::operator=(ZipArchive&&) noexcept = default;

bool ZipArchive::contains(const std::string& name) const {
  return handle_->entries.contains(key_of(name));
}

std::optional<Bytes> ZipArchive::read(const std::string& name) const {
  constexpr std::uint64_t kLargestEntry = std::uint64_t{1} << 30;
  const auto entry = handle_->entries.find(key_of(name));
  if (entry == handle_->entries.end()) return std::nullopt;
  unz_file_info64 info{};
  if (unzGoToFilePos64(handle_->file, &entry->second) != UNZ_OK)
    throw Error(concat(path_.string(), ": damaged; reinstall what it came with"));
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
