// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "mapping_inputs.h"

#include "ovimap/inference/masks/id_mask_sources.h"
#include "ovimap/pipeline/people/peopleless_source.h"

namespace ovimap::apps {

namespace {

constexpr int kStoreForLoops_mb = 1000;  // a closed loop fuses the frames again

}  // namespace

MappingInputs::MappingInputs(const MappingOptions& options, bool recorded)
    : config(read_program_config(options)) {
  config.masks.runtime.threads = network_threads(config, options);
  if (recorded) {
    config.source.poses = options.poses == "auto"    ? PoseNeed::kAllOrNone
                          : options.poses == "track" ? PoseNeed::kNone
                                                     : PoseNeed::kAll;
    source = open_frame_source(options.source, config.source);
  }
  people = make_people_filter(options, config);
  if (people && source) source = std::make_unique<PeoplelessSource>(std::move(source), people);
  tracking = options.poses == "track" || options.poses == "refine" || (source && !source->posed());
  keeps_for_loops = tracking && config.mapper.frame_store.max_mb == 0;
  if (keeps_for_loops) config.mapper.frame_store.max_mb = kStoreForLoops_mb;
  if (!recorded) return;
  range = positions(parse_frame_range(options.frames), source->size());
}

void MappingInputs::open_networks(const MappingOptions& options,
                                  const std::filesystem::path& keep_masks) {
  auto found = make_mask_source(options.masks, config.masks, {source.get(), options.model_dirs});
  if (found && !keep_masks.empty())
    found = std::make_unique<KeptMaskSource>(keep_masks, std::move(found));
  masks = std::move(found);
  encoder = make_encoder(options, config);
  recognizer = make_recognizer(options, config, encoder != nullptr);
}

}  // namespace ovimap::apps
