// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/hub/transfer/folder_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "ovimap/base/error.h"

namespace ovimap {

FolderLock::FolderLock(const std::filesystem::path& file, const std::string& work)
    : descriptor_(open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644)) {
  if (descriptor_ < 0)
    throw Error(concat("cannot write ", file.string(), ": ", std::strerror(errno),
                       "; name another folder with --model-dir"));
  if (flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
  close(descriptor_);
  throw Error(concat(work, " is under way already; wait for it to end"));
}

FolderLock::~FolderLock() {
  close(descriptor_);
}

}  // namespace ovimap
