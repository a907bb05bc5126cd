// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <span>

namespace ovimap {

/// What is too much for memory until its place in a file is known: a file without a name, which
/// goes with the program however that ends.
class ScratchFile {
 public:
  /// On the disk of `target`, the file that its content is meant for. Throws what write_file throws
  /// for it.
  explicit ScratchFile(const std::filesystem::path& target);
  ~ScratchFile();
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  std::uint64_t size() const { return size_; }
  /// Throws Error naming the target when the disk is full.
  void append(std::span<const std::uint8_t> bytes);
  /// Fills `bytes` from what was appended there.
  void read(std::uint64_t offset, std::span<std::uint8_t> bytes) const;

 private:
  std::filesystem::path target_;
  int fd_;
  std::uint64_t size_ = 0;
};

/// A file of `head` and all of `rest`. Replaces `path` only when complete, as write_file does.
void write_file(const std::filesystem::path& path, std::span<const std::uint8_t> head,
                std::initializer_list<const ScratchFile*> rest);

}  // namespace ovimap
