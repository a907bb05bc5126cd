// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/sequence/visit_start.h"

#include <algorithm>

#include "ovimap/base/error.h"

namespace ovimap {

bool shows_known_place(const FrameSource& source, const std::vector<std::int64_t>& positions,
                       const VoxelMap& map, const std::vector<Keyframe>& keyframes,
                       const TrackConfig& track) {
  if (keyframes.empty()) return false;
  Tracker tracker(track);
  tracker.begin_in(keyframes);
  return std::any_of(positions.begin(), positions.end(), [&](std::int64_t position) {
    const FrameRead read = source.read(position);
    return read.frame && tracker.track(*read.frame, map).tracked;
  });
}

ObjectPlacing place_by_objects(const MapDocument& map, const FrameSource& source,
                               const std::vector<std::int64_t>& positions, Mapper&& alone,
                               PoseFinder* finder, const AlignmentConfig& config,
                               const SequenceProgress& progress) {
  const SequenceResult done = run_sequence(source, positions, alone, progress, {}, nullptr, finder);
  if (2 * done.frames.size() < positions.size())
    return {{{},
             concat(finder ? "the camera was lost in " : "there is no use in ",
                    positions.size() - done.frames.size(), " of ", positions.size(), " frames",
                    finder ? " by itself as well" : "")},
            {}};
  const MapDocument part = make_document(std::move(alone), done, {});
  ObjectPlacing placing{search_alignment(map, part, config), {}};
  if (!finder || !placing.alignment.doubt.empty()) return placing;
  placing.places = finder->tracker().keyframes();
  for (Keyframe& place : placing.places)
    place.world_from_camera = placing.alignment.best.a_from_b * place.world_from_camera;
  return placing;
}

}  // namespace ovimap
