// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "ovimap/server/surface/served_surface.h"

namespace ovimap {

/// What is known of a chunk of a saved map once it was made.
struct MadeChunk {
  Eigen::Vector3i index = Eigen::Vector3i::Zero();
  std::array<ChunkTotals, ServedSurface::kLevels> totals;
  /// Levels 1 and 2 as they are sent.
  std::array<std::shared_ptr<const std::string>, ServedSurface::kLevels - 1> coarse;
  BlockErrors errors;
};
using MadeChunks = std::vector<std::shared_ptr<const MadeChunk>>;

/// Where the levels with less detail of a map are kept for the next who serves it. `content_hash`:
/// the map's; `folder`: empty for nowhere.
std::filesystem::path levels_file(const std::filesystem::path& folder, std::uint64_t content_hash);

/// What `write_levels` wrote; empty when there is no such file, or not in this form, or it is
/// damaged: it can be made again.
MadeChunks read_levels(const std::filesystem::path& file);

/// Takes its place when it is complete. A file that cannot be written is done without. Of files
/// beside it the oldest go when they are many.
void write_levels(const std::filesystem::path& file, const MadeChunks& chunks);

}  // namespace ovimap
