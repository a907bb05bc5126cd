// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <optional>

#include "ovimap/server/http/http_message.h"

namespace ovimap {

/// The web page and what belongs to it, read into memory once: a request can only name what was in
/// the folder then, never a path of the file system.
class ViewerFiles {
 public:
  /// An empty `folder`: there is no viewer, and "/" says how to get one. Throws Error when a folder
  /// is named that has no index.html.
  explicit ViewerFiles(const std::filesystem::path& folder);

  bool empty() const { return files_.empty(); }
  /// Nothing where no file has that path.
  std::optional<HttpReply> find(const std::string& path) const;

 private:
  std::map<std::string, HttpReply> files_;
};

/// Where the viewer lies as seen from the program: beside it after an installation
/// (../share/ovimap/viewer), in the build tree (../viewer); empty when in neither.
std::filesystem::path find_viewer(const std::filesystem::path& program);

}  // namespace ovimap
