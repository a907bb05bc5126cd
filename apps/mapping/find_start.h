// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mapping_inputs.h"

namespace ovimap::apps {

/// Sees to it that the camera of a run that tracks it may find its place in the map that the run
/// goes on with. Where none of a new visit's first frames shows a place that the map's keyframes
/// know, the objects of both are asked (place_by_objects), and what they say is left in
/// `inputs.placing` and proposed to the tracker. Throws Error where the map keeps no frames and
/// objects do not tell. Before the mapper is made.
void find_start(const MapDocument& begun, bool new_visit, MappingInputs& inputs);

}  // namespace ovimap::apps
