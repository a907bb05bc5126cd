// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

#include "ovimap/synth/recordings/furniture_portrait.h"

namespace ovimap::apps {

struct CatalogRun {
  std::filesystem::path out, furniture;
  int views = 0;
  std::uint64_t seed = 1;
  bool json = false;
};

/// Writes OUT/crops/NNN_K.jpg (each model by itself), NNN_K.mask.png (255 where it is seen),
/// OUT/crops.csv (file, mask, model, name, category, room class, creator, licence) and
/// OUT/NOTICE.md. Returns an exit code.
int synth_catalog(const CatalogRun& run);

}  // namespace ovimap::apps
