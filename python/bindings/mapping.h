// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "ovimap/io/map_tables/map_document.h"
#include "ovimap/pipeline/sequence/sequence_run.h"
#include "settings.h"

namespace ovimap::python {

/// What a mapper is made with, and what its map says of that.
struct MapperSetup {
  MapperConfig config;
  std::string config_text;
};
MapperSetup mapper_setup(const std::string& preset, const Settings& settings);

/// Whether a frame fits into a map whose frames so far are of `depth_camera` (a width of 0: of none
/// yet). Throws Error for another camera, FrameError for a frame without any depth.
void require_fitting(const Frame& frame, const PinholeCamera& depth_camera);

/// What was mapped, until it is saved; it stays when that fails.
class FinishedMap {
 public:
  bool ready() const { return document_.has_value(); }
  /// Uses the mapper up.
  void take(Mapper&& mapper, const SequenceResult& sequence, const std::string& source,
            const std::string& config_text);
  /// Returns the number of objects. Throws what save_map throws.
  std::size_t save(const std::filesystem::path& path) const;
  void drop() { document_.reset(); }

 private:
  std::optional<MapDocument> document_;
};

}  // namespace ovimap::python
