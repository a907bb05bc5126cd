// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/io/map_tables/map_document.h"

namespace ovimap {

/// The object's box, without specks where its surface is known. Empty where there is no such
/// object.
Eigen::AlignedBox3f box_of(const MapDocument& map, InstanceId id);

/// Whether an object has too little surface for a thing: less than the smallest side of its box,
/// which whatever is closed shows from anywhere, or than `least_filled` of the largest side. The
/// box is the one along the axes of the world or the principal axes of the surface, whichever has
/// the smaller sides. What is left of a thing that went, or was taken for others, lies scattered
/// where it was.
bool is_scattered(const MapDocument& map, InstanceId id, float least_filled);

}  // namespace ovimap
