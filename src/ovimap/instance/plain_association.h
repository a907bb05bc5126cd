// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <vector>

#include "ovimap/instance/association.h"

namespace ovimap::plain {

/// Spatial voting as the paper writes it, pixel by pixel: the label that each segment takes when
/// labels may be shared (argmax), 0 where a segment founds one of its own. What `associate` must
/// equal, and what bench/micro measures it against.
inline std::vector<Label> argmax_labels(const Segments& segments, const Image<VoxelRef>& surface,
                                        const VoxelMap& map, int min_votes) {
  std::vector<std::map<Label, int>> votes(segments.segments.size());
  for (std::size_t i = 0; i < surface.size(); ++i) {
    if (segments.ids[i] == 0 || !surface[i]) continue;
    const Label label = map.label(surface[i]);
    if (label != kNoLabel) ++votes[segments.ids[i] - 1u][label];
  }
  std::vector<Label> winners;
  for (const std::map<Label, int>& of_segment : votes) {
    Label best = kNoLabel;
    int most = min_votes;
    for (const auto& [label, count] : of_segment)
      if (count > most) best = label, most = count;
    winners.push_back(best);
  }
  return winners;
}

}  // namespace ovimap::plain
