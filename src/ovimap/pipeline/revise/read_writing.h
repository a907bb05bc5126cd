// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

#include "ovimap/inference/writing/writing_reader.h"
#include "ovimap/io/map_tables/map_document.h"

namespace ovimap {

class ConfigFields;

/// Which crops of a map are read.
struct ReadWritingConfig {
  int sharpest_views = 2;  ///< of each super-point that keeps crops; 0: all
  float own_share = 0.5f;  ///< of a line that must lie on the object, not beside it
};
void list_fields(ReadWritingConfig& config, ConfigFields& fields);

struct ReadWritingSummary {
  std::size_t crops = 0;  ///< read
  std::size_t lines = 0;  ///< found in them, on their objects
};

/// Called after every super-point.
using ReadWritingProgress = std::function<void(std::size_t done, std::size_t total)>;

/// Reads what is written in the crops that a map kept; what an earlier reading found goes. Throws
/// Error when the map kept no crops, or a kept crop is broken, and what the reader throws; `record`
/// is then as it was.
ReadWritingSummary read_writing(SemanticRecord& record, const WritingReader& reader,
                                const ReadWritingConfig& config = {},
                                const ReadWritingProgress& progress = nullptr);

}  // namespace ovimap
