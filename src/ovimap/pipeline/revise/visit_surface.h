// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <set>

#include "ovimap/io/map_tables/map_document.h"

namespace ovimap {

/// What the last visit saw of a map: its frames, the voxels that they touched, and the objects that
/// show there, with as much of their surface. So neither what hangs where nobody looked, nor what
/// is left of things that went, says that something is there. `before`: the map as the visit found
/// it. Of the rest of the record it has only the camera and what is up.
///
/// `store`: where its voxels may be instead of in memory; null: nowhere.
MapDocument seen_in_visit(const MapDocument& before, const MapDocument& after,
                          std::shared_ptr<BlockStore> store = nullptr);

/// Takes back what is left of things that are gone, where they were: sides that no frame of the
/// visit looked at. `seen`: seen_in_visit of the two maps. Objects of which nothing is left leave
/// the list.
void forget_remains(const MapDocument& before, const MapDocument& seen,
                    const std::set<InstanceId>& gone, MapDocument& after);

/// What will be known of an object when it is not there any more; null where it has no surface.
std::shared_ptr<const PastObject> past_of(const MapDocument& map, InstanceId id);

}  // namespace ovimap
