// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/inference/masks/mask_source.h"

namespace ovimap {

/// The highest id of an image; 0 where it shows none.
std::uint16_t last_id(const IdImage& ids);

/// Entities of any id image: ids become 1, 2, ... in ascending order of the given ones, each with
/// score 1.
Entities entities_of_ids(const IdImage& ids);

/// Drops the entities that show fewer than `min_px` pixels (0: those that show none) and renumbers
/// the others in their order.
Entities keep_visible(Entities entities, int min_px);

}  // namespace ovimap
