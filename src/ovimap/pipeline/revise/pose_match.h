// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "ovimap/io/map_tables/map_document.h"

namespace ovimap {

/// The pose that a file gives each of a map's frames, world_from_camera of the depth camera: by
/// time where its lines have one (TUM), else line by line when there are as many lines as frames,
/// else by each frame's place in its source. `max_gap_s`: between the times of a frame and its
/// pose. Throws Error naming the first frame that gets none, or whose pose is none.
std::vector<Pose> match_poses(const std::vector<FrameLogEntry>& frames,
                              const std::filesystem::path& file, double max_gap_s);

}  // namespace ovimap
