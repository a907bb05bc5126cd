// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "ovimap/eval/trajectories/trajectory_scores.h"
#include "ovimap/io/map_tables/map_document.h"

namespace ovimap {

/// Poses of the depth camera in a map's world, as TUM lines: time tx ty tz qx qy qz qw, the time
/// that of the frame, or its index where frames have no times that grow. Throws Error when the file
/// cannot be written.
void write_trajectory(const std::filesystem::path& file, const std::vector<FrameLogEntry>& frames);

/// The poses of a TUM file, by time. Throws Error for lines that are none.
std::vector<TimedPose> read_timed_poses(const std::filesystem::path& file);

}  // namespace ovimap
