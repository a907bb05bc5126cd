// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "ovimap/map/fusion/seen_free.h"

namespace ovimap {

class ConfigFields;

/// What becomes of things that move while they are seen.
enum class DynamicMode {
  kOff,    ///< they are fused as everything is, and go when frames see through where they were
  kDrop,   ///< they are left out while they move
  kTrack,  ///< likewise, and followed under numbers of their own
};

/// When surface counts as of a thing that moves.
struct MotionConfig {
  DynamicMode mode = DynamicMode::kDrop;
  int looks = 5;              ///< through a cell, until surface in it contradicts them
  float look_step_m = 0.05f;  ///< frames are looks of their own when the camera has moved this far
  float look_turn_rad = 0.05f;  ///< or turned this far since the last,
  float look_s = 0.5f;          ///< or after so long
  float margin_voxels = 3.f;    ///< what lies so far behind the surface, off its plane, must be in
                                ///< such cells as well
  float sigmas = 5.f;           ///< the same along the ray, in standard deviations of the depth
  int least_px = 60;            ///< smaller patches do not count
  float least_area_m2 = 0.01f;  ///< likewise, facing the camera
  float step_share = 0.03f;  ///< neighbours that differ by more of their depth are not one surface
  float grow_m = 1.5f;       ///< what hangs together with such a patch, no further off, moves too,
  float behind_m = 0.5f;     ///< over steps of depth of so much as well
  float known_s = 1.f;       ///< surface that was seen for less long stops nothing of that,
  float beside_m = 0.5f;     ///< and goes as soon as it is seen through, if something moved so near
  int back_guard_px = 1;     ///< by all rays so far around, and up to twice as far
  int edge_px = 2;           ///< and all pixels around that, whose depth may mix both
  float stays_s = 1.5f;      ///< what stands still for so long is part of the place
  float same_thing_m = 0.3f;  ///< tracks: patches nearer to each other are of one thing
  float fastest_mps = 3.f;    ///< tracks: a thing is not the same further off than this allows
  float forget_s = 2.f;       ///< tracks: what was not seen for so long is another thing
};
/// Time as cells of space count it (SpaceCell).
inline int ticks_of(float seconds) {
  return static_cast<int>(std::lround(30.f * seconds));
}

/// Whether what surface the cell holds was seen for the first time so short a time ago that it may
/// be of something that moves.
inline bool is_fresh(const SpaceCell& cell, const MotionConfig& config) {
  return cell.taken < ticks_of(config.known_s);
}

void list_fields(MotionConfig& config, ConfigFields& fields);

}  // namespace ovimap
