// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/pipeline/alignment/map_alignment.h"
#include "ovimap/pipeline/sequence/sequence_run.h"

namespace ovimap {

/// Whether one of the frames at `positions` shows a place of the map that its keyframes know again.
/// Frames that cannot be read show none.
bool shows_known_place(const FrameSource& source, const std::vector<std::int64_t>& positions,
                       const VoxelMap& map, const std::vector<Keyframe>& keyframes,
                       const TrackConfig& track);

/// Where a recording lies in a map, as the objects of both say.
struct ObjectPlacing {
  AlignmentSearch alignment;  ///< of the recording's map in the other
  std::vector<Keyframe>
      places;  ///< of the recording, in the map's world; none where that is doubted
};

/// Maps the frames at `positions` by themselves, in a world of their own, with a mapper that is
/// fresh, and looks for that map in `map` (search_alignment). The camera is tracked by `finder`,
/// likewise fresh; null: the frames have poses, in a world of their own. Throws what run_sequence
/// throws.
ObjectPlacing place_by_objects(const MapDocument& map, const FrameSource& source,
                               const std::vector<std::int64_t>& positions, Mapper&& alone,
                               PoseFinder* finder, const AlignmentConfig& config,
                               const SequenceProgress& progress = nullptr);

}  // namespace ovimap
