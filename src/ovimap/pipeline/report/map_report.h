// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "ovimap/image/codec.h"
#include "ovimap/io/map_tables/map_document.h"
#include "ovimap/pipeline/search/name_guesses.h"

namespace ovimap {

struct MapReportConfig {
  int crops = 4;  ///< of an object, its largest views first
};

/// The guesses and which set of names they were taken from.
struct ReportNames {
  std::string class_set;
  NameGuesses guesses;
};

/// What a report shows beside the map's record.
struct MapReport {
  std::string title;
  float voxel_size_m = 0;
  Bytes instances_picture, colors_picture;  ///< PNG or JPEG from above; empty: left out
  std::optional<ReportNames> names;
  std::string why_no_names;  ///< a sentence for a map with embeddings but no `names`
};

/// A map as one HTML page that needs nothing else: no script, no network, pictures inside. Objects
/// with most surface come first. All texts of the map are escaped.
std::string map_report_html(const MapRecord& map, const MapReport& report,
                            const MapReportConfig& config = {});

}  // namespace ovimap
