// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace ovimap {

/// One thing that a live run did, by what it had time for. All of them, in order, tell how to make
/// its map again, however long things take then.
struct LiveStep {
  enum class Kind {
    kFrame,    ///< took in a frame: fused it, or lost the camera in it
    kMasks,    ///< took in the answer of the mask network about an earlier frame
    kMoved,    ///< was told from outside where the camera had been
    kResumed,  ///< began anew with what is stored; masks that were under way are lost
  };
  Kind kind = Kind::kFrame;
  std::int64_t frame = 0;  ///< FrameLogEntry::index; 0 where the step is of none
  bool asked = false;      ///< kFrame: its masks were asked for
  bool looked = false;     ///< kFrame, kMasks: objects were looked at in it

  friend bool operator==(const LiveStep&, const LiveStep&) = default;
};

}  // namespace ovimap
