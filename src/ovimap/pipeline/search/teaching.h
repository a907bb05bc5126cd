// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>

#include "ovimap/pipeline/search/map_search.h"

namespace ovimap {

/// Where what people taught is kept unless they say otherwise: $XDG_DATA_HOME/ovimap/taught.json,
/// else
/// ~/.local/share/ovimap/taught.json. Throws Error where neither is known.
std::filesystem::path default_taught_file();

/// Keeps the named objects of a map as examples of their names, in place of those that `file` had
/// of it: a name that was taken away is forgotten. Returns how many. `map`: the map's file;
/// `search`: of it as it is corrected now. Throws Error where the file cannot be read or written.
std::size_t teach(const std::filesystem::path& file, const std::filesystem::path& map,
                  const MapSearch& search);

/// What `file` holds of things in other maps, seen by the encoder of this one. Empty `file`:
/// nothing.
TaughtThings taught_elsewhere(const std::filesystem::path& file, const std::filesystem::path& map,
                              const EncoderIdentity& encoder);

}  // namespace ovimap
