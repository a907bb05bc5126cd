// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "mapping_inputs.h"
#include "ovimap/pipeline/live/frame_intake.h"

namespace ovimap::apps {

/// Sees to it that the camera of a run that tracks it may find its place in the map that the run
/// goes on with. Where none of a new visit's first frames shows a place that the map's keyframes
/// know, the objects of both are asked (place_by_objects), and what they say is left in
/// `inputs.placing` and proposed to the tracker. Throws Error where the map keeps no frames and
/// objects do not tell. Before the mapper is made.
void find_start(const MapDocument& begun, bool new_visit, MappingInputs& inputs);

/// Moves a recording whose poses are in a world of their own to where it lies in the map: by what
/// its frames say, where the poses are off by no more than a step, else by the objects of both
/// (place_by_objects), and then by the frames. Throws Error where neither tells, and where poses
/// are tracked.
void align_recording(const MapDocument& map, MappingInputs& inputs);

/// Throws Error unless the frames of a new visit lie where the map is: those of the recording or,
/// where it is given, the first that come to `intake`, which stay there. Where poses are tracked
/// anything fits.
void require_fit(const MapDocument& begun, const MappingInputs& inputs, FrameIntake* intake);

/// Throws Error for a new visit that was before the map's last one: visits lie in the order in
/// which they were mapped, and questions about the past would be answered out of order.
/// `recorded_s`: when it was, as people said; else its first frame tells, where frames' times are
/// dates.
void require_later(const MapRecord& begun, std::optional<double> recorded_s,
                   const MappingInputs& inputs);

/// Who looks in vain for what changed may have given the recording of before: warns of it.
void warn_of_known_recording(const MapRecord& begun, const std::string& source);

/// Throws Error unless the frames of which the map was made, by position in the recording, lie in
/// it: else two places would. Likewise.
void require_same_recording(const MapDocument& begun, const MappingInputs& inputs,
                            const std::vector<std::int64_t>& done);

}  // namespace ovimap::apps
