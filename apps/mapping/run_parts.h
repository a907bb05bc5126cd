// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mapping_run.h"

namespace ovimap::apps {

/// Maps what a run could not place, each stretch of frames by itself into a map beside `map`
/// ("room.part2.ovimap", "room.part3.ovimap", ...): a map has one world, and nothing says how a
/// place lies in it that shows nothing of what it holds. What such a stretch loses in turn is
/// mapped likewise. Stretches of which less than half can be tracked are not kept. Returns the
/// parts, in the order of their files.
std::vector<MapPart> map_parts(const MappingOptions& options, const std::filesystem::path& map,
                               const MappingRun& run);

}  // namespace ovimap::apps
