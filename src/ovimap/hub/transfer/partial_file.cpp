// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/hub/transfer/partial_file.h"

#include <cerrno>
#include <cstring>

#include "ovimap/base/error.h"

namespace ovimap {

namespace fs = std::filesystem;

PartialFile::PartialFile(fs::path path, std::uint64_t expected_bytes)
    : path_(std::move(path)), expected_bytes_(expected_bytes), file_(nullptr, std::fclose) {
  std::error_code absent;
  const std::uintmax_t there = fs::file_size(path_, absent);
  const bool fits = !absent && there <= expected_bytes_;
  bytes_ = fits ? there : 0;
  open(fits ? "ab" : "wb");
}

void PartialFile::open(const char* mode) {
  file_.reset(std::fopen(path_.c_str(), mode));
  if (!file_) throw Error(concat("cannot write ", path_.string(), ": ", std::strerror(errno)));
}

void PartialFile::restart() {
  open("wb");
  bytes_ = 0;
}

bool PartialFile::write(std::uint64_t from, std::span<const char> bytes) {
  if (!begun_ && from != bytes_) restart();
  begun_ = true;
  if (bytes_ + bytes.size() > expected_bytes_) {
    fault_ = concat("more than the listed ", expected_bytes_, " bytes came for ", path_.string(),
                    "; run it again later");
    return false;
  }
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size() ||
      std::fflush(file_.get()) != 0) {
    fault_ = concat("cannot write ", path_.string(), ": ", std::strerror(errno),
                    "; make room or name another folder with --model-dir");
    return false;
  }
  bytes_ += bytes.size();
  return true;
}

}  // namespace ovimap
