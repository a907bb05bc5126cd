// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ovimap/instance/instance_registry.h"

namespace ovimap {

/// What a person can correct in a map. docs/edit.md says what each does.
enum class EditAction {
  kRename,  ///< `instances[0]` is called `name`; an empty name takes it away
  kMerge,   ///< `instances` are one object, which keeps the first id
  kSplit,   ///< `super_points` leave `instances[0]` and become an object of their own
  kLock,    ///< `instances[0]` keeps exactly the super-points that it has
  kDelete,  ///< `instances[0]` is no object; its surface stays as background
  kHide,    ///< `instances[0]` is left out of lists, answers and pictures
  kUndo,    ///< edit `undoes` has no effect any more; undoing an undo brings it back
};

/// One line of a map's log of corrections. Whoever asks for one fills in the action and what it
/// speaks of; edit_map adds the rest.
struct MapEdit {
  EditAction action = EditAction::kRename;
  std::vector<InstanceId> instances;
  std::string name;                 ///< kRename
  std::vector<Label> super_points;  ///< kSplit: those that leave; kLock: those that stay
  std::int64_t undoes = 0;          ///< kUndo; 0: the latest edit that has an effect
  std::string note;                 ///< why, in words; may be empty

  std::int64_t id = 0;          ///< 1, 2, ... as they came
  double time_s = 0;            ///< when, seconds since 1970 UTC
  InstanceId new_instance = 0;  ///< kSplit: the id of what was split off
  std::int64_t undone_by = 0;   ///< the edit that took this one's effect away; 0: none

  bool operator==(const MapEdit&) const = default;
};
using MapEdits = std::vector<MapEdit>;

}  // namespace ovimap
