// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/io/map_tables/map_document.h"

namespace ovimap {

/// The map's mesh with the ids of its instances as labels, 0 elsewhere, and without the surface of
/// hidden objects.
Mesh visible_mesh(const MapDocument& document);

}  // namespace ovimap
