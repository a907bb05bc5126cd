// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "ovimap/geometry/mesh.h"
#include "ovimap/synth/recordings/sequence.h"

namespace ovimap {

/// What a recording must show of a thing for it to be scored.
struct ScoredThingsConfig {
  float least_side_m = 0.03f;    ///< the longest side of its box
  float least_area_m2 = 0.002f;  ///< of its surface that is seen at all
  int least_pixels = 100;        ///< of a frame of 640x480, in ...
  int least_frames = 5;          ///< ... so many frames
};

/// The ids of the sequence's things that fall short, in their order; `truth` is its truth_mesh.
std::vector<std::uint32_t> little_seen(const SynthSequence& sequence, const Mesh& truth,
                                       const ScoredThingsConfig& config = {});

}  // namespace ovimap
