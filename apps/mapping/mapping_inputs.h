// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mapping_run.h"
#include "ovimap/pipeline/people/people_filter.h"

namespace ovimap::apps {

/// What the options ask for, opened.
struct MappingInputs {
  /// `recorded`: the source is a recording; else frames are pushed.
  explicit MappingInputs(const MappingOptions& options, bool recorded = true);

  void open_networks(const MappingOptions& options, const std::filesystem::path& keep_masks = {});

  ProgramConfig config;
  std::unique_ptr<FrameSource> source;         ///< null where frames are pushed
  std::shared_ptr<const PeopleFilter> people;  ///< null: they stay in the frames
  bool tracking = false;                       ///< poses are to be found
  bool keeps_for_loops = false;                ///< frames are kept for that alone
  std::vector<std::int64_t> range;
  std::shared_ptr<MaskSource> masks;
  std::shared_ptr<ImageTextEncoder> encoder;
  std::shared_ptr<const ThingRecognizer> recognizer;
  std::shared_ptr<PoseFinder> finder;      ///< null: poses are given
  std::optional<AlignmentSearch> placing;  ///< what objects said of where the recording lies
  std::optional<Pose>
      map_from_recording;  ///< by which its poses were moved; nullopt: they were not
};

}  // namespace ovimap::apps
