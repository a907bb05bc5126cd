// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ovimap/io/map_tables/map_document.h"
#include "ovimap/map/rays/observed_space.h"

namespace ovimap {

class ConfigFields;

struct MapDiffConfig {
  float tolerance_m = 0.03f;  ///< surfaces nearer to each other are at the same place
  float same_iou = 0.2f;      ///< overlap at which two objects are one
  float same_share = 0.6f;  ///< or of either one's points: a part of it, found as a thing by itself
  float gone_share = 0.5f;  ///< of an object's points that the other map saw through
  float shift_share = 0.25f;  ///< the same on both sides of an object that moved a little
  int gone_views = 2;         ///< cameras that must have looked through a point
  float moved_cosine = 0.6f;  ///< of the looks, before and after
  float moved_rank = 0.2f;    ///< share of the other objects that may look even more like it
  float moved_size = 0.5f;    ///< similarity of size, before and after
  ObservedSpaceConfig space;
};
void list_fields(MapDiffConfig& config, ConfigFields& fields);

enum class ChangeKind {
  kSame,     ///< in both maps, at the same place
  kMoved,    ///< in both maps, at another place
  kRemoved,  ///< the later map saw through its place
  kNew,      ///< the earlier map saw through its place
  kUnseen,   ///< one map did not look there: nothing can be said
};
const char* change_name(ChangeKind kind);  ///< "same", "moved", "removed", "new", "unseen"

/// An object of either map and what became of it.
struct ObjectChange {
  ChangeKind kind = ChangeKind::kSame;
  InstanceId before = 0, after = 0;  ///< ids in the two maps; 0: in that map it is not
  float overlap = 0;                 ///< intersection over union of the surfaces
  float seen_through = 0;            ///< share of its points that the other map saw through
  float surface_there = 0;           ///< share of its points at which the other map has surface
  std::optional<float> cosine;       ///< of the looks, where both are known
  Eigen::Vector3f shift_m = Eigen::Vector3f::Zero();  ///< of the centroid, in the frame of `before`
  std::string evidence;                               ///< a sentence
};

/// Whether the other map saw through where the object is. What lies within the tolerance of other
/// surface tells neither: all of a small thing does, on its side to the table.
bool is_away(const ObjectChange& change, const MapDiffConfig& config);

/// What was found where another thing was is a thing of its own: takes it from that one's change
/// and returns it as new.
ObjectChange part_arrival(ObjectChange& change);

/// What changed from one map to another, both corrected. `before_from_after` takes points of the
/// later map to the frame of the earlier one. Objects of the earlier map first, then new ones.
std::vector<ObjectChange> diff_maps(const MapDocument& before, const MapDocument& after,
                                    const Pose& before_from_after,
                                    const MapDiffConfig& config = {});

}  // namespace ovimap
