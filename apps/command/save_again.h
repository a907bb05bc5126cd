// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "ovimap/io/map_tables/map_document.h"

namespace ovimap::apps {

/// Saves as `out` what was made of the map at `made_of` (empty: of none). Where it takes that map's
/// place it has what people corrected there meanwhile; says which corrections fit it no more.
void save_again(const std::filesystem::path& made_of, const std::filesystem::path& out,
                MapDocument& document);

}  // namespace ovimap::apps
