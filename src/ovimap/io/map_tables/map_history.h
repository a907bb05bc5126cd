// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "ovimap/instance/instance_registry.h"

namespace ovimap {

/// One recording of those that went into a map.
struct MapVisit {
  std::string source;            ///< where its frames came from
  std::int64_t first_frame = 0;  ///< its first in MapRecord::frames, by place
  std::int64_t first_index = 0;  ///< FrameLogEntry::index of position 0 of the recording

  bool operator==(const MapVisit&) const = default;
};

enum class ObjectEventKind {
  kAppeared,  ///< a visit found it where earlier ones had nothing
  kGone,      ///< its surface was seen through
  kMoved,     ///< it is the object of this id, found elsewhere
};

/// What a visit changed about an object.
struct ObjectEvent {
  InstanceId instance = 0;
  ObjectEventKind kind = ObjectEventKind::kAppeared;
  int visit = 1;           ///< in which it was noticed, from 1
  std::int64_t frame = 0;  ///< place in MapRecord::frames of the frame that showed it first there, or
                           ///< of the visit's last frame where there is none (kGone)
  Eigen::AlignedBox3f before, after;  ///< where it was and is; empty: nowhere
  InstanceId may_be = 0;  ///< kAppeared: the gone object that it resembles, without certainty; 0: none
};

/// The visits of a map, in order, and what they changed, visit by visit and by instance.
struct MapHistory {
  std::vector<MapVisit> visits;
  std::vector<ObjectEvent> events;
};

}  // namespace ovimap
