// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "ovimap/frames/check/source_check.h"

namespace ovimap {

struct DepthSurfaceConfig;

/// check_source of a path, opened without limits of depth, so that depth in a wrong unit is seen as
/// such, and how much the depth errs, as some frames tell of themselves (read_noise). Only the
/// frames of `range` are looked at, as if there were no others. Throws Error when it cannot be
/// opened or the range is empty.
CheckReport check_recording(const std::filesystem::path& path, const SourceCheckConfig& config = {},
                            const FrameRange& range = {});

/// Medians over up to a dozen frames that can be used and are large enough to tell, at 0.5, 1, 2, 4
/// and 8 m, where a twentieth of a frame's depth lies within half as much again. Ascending; empty
/// where no frame tells. Threads do not change it.
std::vector<DepthError> measure_depth_errors(const FrameSource& source,
                                             const DepthSurfaceConfig& config);

}  // namespace ovimap
