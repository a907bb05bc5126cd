// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

namespace ovimap {

/// A file that comes in pieces, over several transfers.
class PartialFile {
 public:
  /// Goes on with what lies at `path`, if it is no more than `expected_bytes`. Throws Error when it
  /// cannot be written.
  PartialFile(std::filesystem::path path, std::uint64_t expected_bytes);

  std::uint64_t bytes() const { return bytes_; }
  /// Why write() said false; empty: it did not.
  const std::string& fault() const { return fault_; }

  /// Puts the next bytes of a transfer that began at the byte `from` of the file, which throws away
  /// what does not fit: a server that knows no ranges begins at 0. False when they cannot be
  /// written, or would be more than expected.
  bool write(std::uint64_t from, std::span<const char> bytes);
  void restart();

 private:
  void open(const char* mode);

  std::filesystem::path path_;
  std::uint64_t expected_bytes_, bytes_ = 0;
  bool begun_ = false;
  std::string fault_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
};

}  // namespace ovimap
