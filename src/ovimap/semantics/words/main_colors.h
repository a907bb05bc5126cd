// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include "ovimap/semantics/words/colors.h"

namespace ovimap {

/// The colours of an object to tell people, with their shares: largest first, without those of less
/// than a tenth, which are shadows and the edges of what is behind. None where they are not known.
std::vector<std::pair<Color, float>> main_colors(const ColorShares& shares);

}  // namespace ovimap
