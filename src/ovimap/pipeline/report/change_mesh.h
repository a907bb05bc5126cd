// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "ovimap/geometry/mesh.h"
#include "ovimap/pipeline/revise/map_diff.h"
#include "ovimap/pipeline/search/past_objects.h"

namespace ovimap {

/// The later map in grey in the frame of the earlier one, with changes in colour: new things green,
/// moved ones blue and where they were light blue, removed ones red. Both corrected.
Mesh change_mesh(const MapDocument& before, const MapDocument& after, const Pose& before_from_after,
                 const std::vector<ObjectChange>& changes);

/// The same of one corrected map and what its history tells (changes_between): its surface of now,
/// and what it kept of where things were, a little cube a point; boxes where it kept nothing.
Mesh change_mesh(const MapDocument& map, const std::vector<HistoryChange>& changes);

}  // namespace ovimap
