// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/base/installation/installed_data.h"

#include <dlfcn.h>

namespace ovimap {

namespace fs = std::filesystem;

std::optional<fs::path> data_installed_with(const fs::path& code, const std::string& name) {
  const fs::path beside = code.parent_path();
  for (const fs::path& prefix : {beside, beside.parent_path()}) {
    const fs::path folder = prefix / "share/ovimap" / name;
    std::error_code unreadable;
    if (fs::is_directory(folder, unreadable)) return folder;
  }
  return {};
}

std::optional<fs::path> installed_data(const std::string& name) {
  std::error_code absent;  // no /proc: the module remains
  const fs::path program = fs::read_symlink("/proc/self/exe", absent);
  if (const auto found = data_installed_with(program, name)) return found;
  Dl_info module;
  if (dladdr(reinterpret_cast<const void*>(&installed_data), &module) == 0) return {};
  return data_installed_with(fs::path(module.dli_fname), name);
}

}  // namespace ovimap
