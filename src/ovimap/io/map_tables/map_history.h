// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
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
  std::optional<double> recorded_s =
      {};  ///< when it was made, seconds since 1970 (UTC), as people said

  bool operator==(const MapVisit&) const = default;
};

/// An object as it was before a visit found it gone or moved. World frame, metres.
struct PastObject {
  Eigen::Vector3f centroid = Eigen::Vector3f::Zero();
  std::size_t points = 0;                           ///< surface voxels
  int views = 0;                                    ///< frames in which it was seen
  std::vector<Label> super_points;                  ///< whose looks are its own
  std::vector<Eigen::Vector3f> surface;             ///< thinned
  std::vector<std::array<std::uint8_t, 3>> colors;  ///< sRGB of each point; all 0: unknown
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
  std::int64_t frame = 0;  ///< place in MapRecord::frames of the frame that showed it first there,
                           ///< or of the visit's last frame where there is none (kGone)
  Eigen::AlignedBox3f before, after;  ///< where it was and is; empty: nowhere
  InstanceId may_be =
      0;  ///< kAppeared: the gone object that it resembles, without certainty; 0: none
  std::shared_ptr<const PastObject> was = {};  ///< what it was at `before`; null: nobody kept it
};

/// Where something that moved was in one frame.
struct MoverStep {
  std::int64_t frame = 0;  ///< FrameLogEntry::index
  Eigen::Vector3f place =
      Eigen::Vector3f::Zero();  ///< middle of what was seen of it; world, metres

  bool operator==(const MoverStep&) const = default;
};

/// Something that moved while it was seen, and was left out of the map.
struct Mover {
  int id = 0;  ///< 1, 2, ... by the frame that saw it first; no instance id
  Eigen::Vector3f size_m = Eigen::Vector3f::Zero();  ///< the largest box that was seen of it
  std::vector<MoverStep> path;                       ///< never empty

  bool operator==(const Mover&) const = default;
};

/// The visits of a map, in order, and what they changed, visit by visit and by instance.
struct MapHistory {
  std::vector<MapVisit> visits;
  std::vector<ObjectEvent> events;
};

/// The objects of which the last event says that they are gone: what a map still has under such an
/// id is what is left of it on what it stood on, and no object.
inline std::set<InstanceId> gone_objects(const MapHistory& history) {
  std::set<InstanceId> gone;
  for (const ObjectEvent& event : history.events)
    if (event.kind == ObjectEventKind::kGone)
      gone.insert(event.instance);
    else
      gone.erase(event.instance);
  return gone;
}

}  // namespace ovimap
