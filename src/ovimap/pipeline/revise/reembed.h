// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

#include "ovimap/io/map_tables/map_document.h"

namespace ovimap {

struct ReembedSummary {
  std::size_t super_points = 0;  ///< with an embedding now
  std::size_t views = 0;         ///< kept crops that were embedded
  std::size_t dropped = 0;       ///< views without a kept crop, which lose their embedding
};

/// Called after every super-point.
using ReembedProgress = std::function<void(std::size_t done, std::size_t total)>;

/// Embeds the crops that a map kept with another encoder, as if it had been there when the map was
/// made; no frame is needed. Throws Error when the map kept no crops, or a kept crop is broken, and
/// what the encoder throws; `record` is then as it was.
ReembedSummary reembed(SemanticRecord& record, ImageTextEncoder& encoder,
                       const ReembedProgress& progress = nullptr);

}  // namespace ovimap
