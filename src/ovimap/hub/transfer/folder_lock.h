// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace ovimap {

/// Held by one process at a time; the system lets go of it however the process ends.
class FolderLock {
 public:
  /// Throws Error when another process holds it: "`work` is under way".
  FolderLock(const std::filesystem::path& file, const std::string& work);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace ovimap
