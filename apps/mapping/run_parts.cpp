// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "run_parts.h"

#include <deque>

#include "ovimap/io/map_file/map_checkpoint.h"
#include "ovimap/io/map_file/map_file.h"
#include "ovimap/io/map_file/map_file_access.h"

namespace ovimap::apps {

namespace {

using Stretch = std::pair<std::int64_t, std::int64_t>;  // first and last frame

std::filesystem::path part_path(std::filesystem::path map, std::size_t number) {
  const std::string extension = map.extension().string();
  map.replace_extension();
  map += concat(".part", number, extension);
  return map;
}

/// The same run of these frames alone, in a world of their own.
MappingOptions options_for(MappingOptions options, const Stretch& stretch) {
  const std::int64_t step = parse_frame_range(options.frames).step;
  options.frames = concat(stretch.first, ":", stretch.second + 1, ":", step);
  options.settings.emplace_back("allow_still_camera=true");  // the recording as a whole moved
  return options;
}

/// Where objects say that a part lies in the map. Both must be in memory.
std::optional<AlignmentSearch> placed_in(const MapDocument& map, const MapDocument& part) {
  if (map.map.has_store() || part.map.has_store()) return std::nullopt;
  return search_alignment(map, part);
}

void add_unknown(const TrackingRun& tracking, std::deque<Stretch>& wanted) {
  wanted.insert(wanted.end(), tracking.unknown.begin(), tracking.unknown.end());
}

}  // namespace

std::vector<MapPart> map_parts(const MappingOptions& options, const std::filesystem::path& map,
                               const MappingRun& run) {
  std::vector<MapPart> parts;
  std::deque<Stretch> wanted;
  if (run.tracking) add_unknown(*run.tracking, wanted);
  for (; !wanted.empty() && !interrupted(); wanted.pop_front()) {
    const Stretch stretch = wanted.front();
    const RunTarget target{part_path(map, parts.size() + 2)};
    remove_map(checkpoint_path(target.map));  // what a killed run left of it is begun anew
    const MappingRun part =
        map_recording(options_for(options, stretch), "mapping a part", {}, target);
    const TrackSummary& summary = part.tracking->summary;
    if (2 * summary.tracked >= summary.frames) {
      save_map(target.map, part.document);
      parts.push_back({target.map, stretch.first, stretch.second, part.sequence.frames.size(),
                       part.document.instances.size(), placed_in(run.document, part.document)});
      add_unknown(*part.tracking, wanted);
    }
    part.checkpoints->remove();
  }
  return parts;
}

}  // namespace ovimap::apps
