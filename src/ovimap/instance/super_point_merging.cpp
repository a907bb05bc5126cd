// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/instance/super_point_merging.h"

#include <algorithm>
#include <set>

#include "ovimap/base/config.h"

namespace ovimap {

void list_fields(MergeConfig& config, ConfigFields& fields) {
  fields.add("merge_min_count", config.merge_min_count, 0, 1000000,
             "super-points merge when more segments than this span both");
  fields.add("merge_max_dissent", config.merge_max_dissent, 0.f, 1e6f,
             "... and at most this many frames keep them apart per segment that spans them "
             "(1000000: the paper)");
}

std::vector<SuperPointMerging::Merge> SuperPointMerging::observe(
    std::span<const SegmentAssociation> associations, LabelForest& forest) {
  count_joined(associations);
  count_apart(associations);
  std::vector<Merge> merges;
  for (auto found = counts_.begin(); found != counts_.end();) {
    if (!ripe(found->second)) {
      ++found;
      continue;
    }
    const auto [keep, drop] = found->first;
    forest.merge(keep, drop);
    rename(keep, drop);
    merges.push_back({keep, drop});
    found = counts_.begin();  // a merge renames and combines counts, which may ripen others
  }
  return merges;
}

bool SuperPointMerging::ripe(const PairCount& count) const {
  return count.joined > config_.merge_min_count &&
         static_cast<float>(count.apart) <=
             config_.merge_max_dissent * static_cast<float>(count.joined);
}

void SuperPointMerging::count_joined(std::span<const SegmentAssociation> associations) {
  for (const SegmentAssociation& segment : associations)
    for (std::size_t i = 0; i < segment.overlapped.size(); ++i)
      for (std::size_t j = i + 1; j < segment.overlapped.size(); ++j)
        ++counts_[std::minmax(segment.overlapped[i], segment.overlapped[j])].joined;
}

void SuperPointMerging::count_apart(std::span<const SegmentAssociation> associations) {
  std::set<Label> seen;
  for (const SegmentAssociation& segment : associations) seen.insert(segment.label);
  std::set<std::pair<Label, Label>> joined_now;
  for (const SegmentAssociation& segment : associations)
    for (Label a : segment.overlapped)
      for (Label b : segment.overlapped) joined_now.emplace(a, b);
  for (auto& [pair, count] : counts_)
    if (seen.contains(pair.first) && seen.contains(pair.second) && !joined_now.contains(pair))
      ++count.apart;
}

/// Counts of the dropped label go to the kept one. Combined by maximum: the two histories overlap
/// in time.
void SuperPointMerging::rename(Label keep, Label drop) {
  PairCounts renamed;
  for (const auto& [pair, count] : counts_) {
    const Label a = pair.first == drop ? keep : pair.first,
                b = pair.second == drop ? keep : pair.second;
    if (a == b) continue;
    PairCount& into = renamed[std::minmax(a, b)];
    into.joined = std::max(into.joined, count.joined);
    into.apart = std::max(into.apart, count.apart);
  }
  counts_ = std::move(renamed);
}

}  // namespace ovimap
