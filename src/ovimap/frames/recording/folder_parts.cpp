// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/recording/folder_parts.h"

#include <algorithm>
#include <map>

#include "ovimap/base/error.h"
#include "ovimap/base/text/ascii.h"
#include "ovimap/frames/recording/natural_order.h"
#include "ovimap/frames/recording/number_text.h"

namespace ovimap {

namespace fs = std::filesystem;

fs::path find_one(const fs::path& folder, const Names& names, bool as_folder) {
  for (const char* name : names) {
    const fs::path path = folder / name;
    if (as_folder ? fs::is_directory(path) : fs::is_regular_file(path)) return path;
  }
  return {};
}

std::vector<fs::path> list_files(const fs::path& folder, const Names& extensions) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string extension = lower_case(entry.path().extension().string());
    if (std::find(extensions.begin(), extensions.end(), extension) != extensions.end())
      files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
    return natural_less(a.filename().string(), b.filename().string());
  });
  return files;
}

fs::path find_file(const fs::path& source, const char* extension) {
  if (fs::is_regular_file(source)) return source.extension() == extension ? source : fs::path();
  const std::vector<fs::path> files = list_files(source, {extension});
  if (files.size() > 1)
    throw Error(concat(source.string(), " holds ", files.size(), " ", extension,
                       " files; give one of them, as ", files.front().string()));
  return files.empty() ? fs::path() : files.front();
}

std::vector<fs::path> partner_files(const std::vector<fs::path>& colors, const fs::path& folder,
                                    const std::string& extension) {
  const std::vector<fs::path> files = list_files(folder, {extension.c_str()});
  std::map<std::string, fs::path> by_stem;
  for (const fs::path& file : files) by_stem[file.stem().string()] = file;
  std::vector<fs::path> found;
  bool any_equal = false;
  for (const fs::path& color : colors) {
    const auto partner = by_stem.find(color.stem().string());
    any_equal |= partner != by_stem.end();
    found.push_back(partner != by_stem.end() ? partner->second
                                             : folder / (color.stem().string() + extension));
  }
  if (any_equal) return found;
  if (files.size() == colors.size()) return files;
  if (files.empty() && extension == ".png")
    throw Error(concat(folder.string(), " holds no .png file; depth is read from PNG of 16 bits"));
  throw Error(
      concat(folder.string(), " has ", files.size(), " ", extension, " files for ", colors.size(),
             " colour images and no name in common; name them alike (color/12.jpg, depth/12.png)"));
}

void read_text_intrinsics(const fs::path& file, PinholeCamera& camera) {
  const auto numbers = read_numbers(file);
  const std::size_t count = numbers ? numbers->size() : 0;
  if (count == 4) {
    camera = {0,
              0,
              float((*numbers)[0]),
              float((*numbers)[1]),
              float((*numbers)[2]),
              float((*numbers)[3])};
  } else if (count == 9 || count == 16) {
    const std::size_t row = count == 9 ? 3 : 4;
    camera = {0,
              0,
              float((*numbers)[0]),
              float((*numbers)[row + 1]),
              float((*numbers)[2]),
              float((*numbers)[row + 2])};
  } else {
    throw Error(concat(file.string(),
                       " holds no intrinsics; accepted are 'fx fy cx cy' or a 3x3 or 4x4 matrix"));
  }
}

}  // namespace ovimap
