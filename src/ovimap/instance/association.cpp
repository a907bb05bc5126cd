// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/instance/association.h"

#include <algorithm>
#include <map>
#include <queue>
#include <tuple>

#include "ovimap/base/config.h"
#include "ovimap/base/parallel.h"
#include "ovimap/map/rays/surface_lookup.h"
#include "ovimap/map/voxels/label_slots.h"

namespace ovimap {

namespace {

constexpr std::size_t kPixelsPerTask = 16 * 640;
constexpr std::uint32_t kRivalParts = 2;  // a voxel's second choice has half of the first's support

using Votes = std::map<Label, int>;

/// (segment, label) in one word, segment in the high half.
std::uint64_t ballot(std::uint16_t segment, Label label) {
  return std::uint64_t{segment} << 32 | label;
}

/// Votes of every segment for the labels of its surface voxels; runs of equal ballots are counted
/// as one.
std::vector<Votes> count_votes(const Segments& segments, const Image<VoxelRef>& surface,
                               const VoxelMap& map) {
  const std::size_t tasks = (surface.size() + kPixelsPerTask - 1) / kPixelsPerTask;
  std::vector<std::vector<std::pair<std::uint64_t, int>>> runs(tasks);
  parallel_for(tasks, 1, [&](std::size_t task) {
    const std::size_t end = std::min((task + 1) * kPixelsPerTask, surface.size());
    LabelReader labels(map);
    for (std::size_t i = task * kPixelsPerTask; i < end; ++i) {
      const std::uint16_t segment = segments.ids[i];
      if (segment == 0 || !surface[i]) continue;
      const Label label = labels.at(surface[i]);
      if (label == kNoLabel) continue;
      const std::uint64_t key = ballot(segment, label);
      if (!runs[task].empty() && runs[task].back().first == key)
        ++runs[task].back().second;
      else
        runs[task].emplace_back(key, 1);
    }
  });
  std::vector<Votes> votes(segments.segments.size());
  for (const auto& part : runs)
    for (const auto& [key, count] : part) votes[(key >> 32) - 1][static_cast<Label>(key)] += count;
  return votes;
}

/// A segment takes and shows super-points that have more votes than this.
int votes_needed(int area_px, const AssociationConfig& config) {
  return std::max(config.assoc_min_votes,
                  static_cast<int>(config.assoc_min_share * static_cast<float>(area_px)));
}

/// Most votes; the lower (older) label on a tie.
std::pair<Label, int> winner(const Votes& votes) {
  std::pair<Label, int> best{kNoLabel, 0};
  for (const auto& [label, count] : votes)
    if (count > best.second) best = {label, count};
  return best;
}

/// Greedy one-to-one assignment: the pair with most votes first; a segment whose label is taken
/// votes again, every point for the best label of its voxel that is still free (reference
/// code, 2.5).
class OneToOne {
 public:
  OneToOne(const Segments& segments, const Image<VoxelRef>& surface, const VoxelMap& map,
           const AssociationConfig& config)
      : segments_(segments), surface_(surface), map_(map), config_(config) {}

  void assign(const std::vector<Votes>& votes, std::vector<SegmentAssociation>& result) {
    for (std::size_t segment = 0; segment < votes.size(); ++segment)
      enqueue(segment, votes[segment]);
    while (!queue_.empty()) {
      const auto [count, order, label] = queue_.top();
      queue_.pop();
      const std::size_t segment = votes.size() - 1 - order;
      if (!is_free(label, segment)) {
        enqueue(segment, vote_again(segment));
        continue;
      }
      owner_.try_emplace(label, segment);
      result[segment].label = label;
    }
  }

 private:
  /// Whether the segment may take the label in this frame.
  bool is_free(Label label, std::size_t segment) const {
    const auto found = owner_.find(label);
    if (found == owner_.end()) return true;
    return is_mixed() &&
           segments_.segments[segment].entity == segments_.segments[found->second].entity;
  }

  bool is_mixed() const { return config_.association == AssociationRule::kMixed; }

  void enqueue(std::size_t segment, const Votes& votes) {
    const auto [label, count] = winner(votes);
    // Among equals the lower segment goes first: the queue serves the largest tuple.
    if (count > votes_to_take(segments_.segments[segment]))
      queue_.emplace(count, segments_.segments.size() - 1 - segment, label);
  }

  /// Of a mask that its source rates at 0.6, some 0.4 is not the thing: a super-point that shows in
  /// no more of it may be of what the mask holds by mistake, and would be given the rest. (Not the
  /// paper's: its rule knows no ratings.)
  int votes_to_take(const Segment& segment) const {
    const std::size_t entity = segment.entity;
    const bool rated = is_mixed() && entity > 0 && entity <= segments_.ratings.size();
    const float mistaken = rated ? 1 - segments_.ratings[entity - 1] : 0;
    return std::max(votes_needed(segment.area_px, config_),
                    static_cast<int>(mistaken * static_cast<float>(segment.area_px)));
  }

  /// What has little support in its voxel is noise of earlier frames: where another thing came to
  /// lie, its segment would be given to one that hardly was there.
  Votes vote_again(std::size_t segment) {
    if (pixels_.empty()) list_pixels();
    Votes votes;
    for (std::uint32_t pixel : pixels_[segment]) {
      const VoxelRef ref = surface_[pixel];
      const VoxelLabels labels = voxel_labels(map_.block(ref.block()), ref.voxel(), map_.labels());
      for (const LabelSupport& held : labels) {
        if (held.label == kNoLabel) break;
        if (is_mixed() && kRivalParts * held.support < labels[0].support) break;
        if (!is_free(held.label, segment)) continue;
        ++votes[held.label];
        break;
      }
    }
    return votes;
  }

  /// Most frames have few disputes, and frames without masks none: listed when first needed.
  void list_pixels() {
    pixels_.resize(segments_.segments.size());
    for (std::uint32_t i = 0; i < surface_.size(); ++i)
      if (segments_.ids[i] != 0 && surface_[i]) pixels_[segments_.ids[i] - 1u].push_back(i);
  }

  const Segments& segments_;
  const Image<VoxelRef>& surface_;
  const VoxelMap& map_;
  const AssociationConfig& config_;
  std::vector<std::vector<std::uint32_t>> pixels_;
  std::map<Label, std::size_t> owner_;  ///< the first segment that took a label
  std::priority_queue<std::tuple<int, std::size_t, Label>> queue_;
};

/// Labels that one segment shows to belong together: inputs of Spa (paper, supplement; method
/// section 6).
std::vector<Label> overlapped_labels(const Votes& votes, int area_px,
                                     const AssociationConfig& config) {
  std::vector<Label> labels;
  if (area_px <= config.merge_min_points) return labels;
  for (const auto& [label, count] : votes)
    if (static_cast<float>(count) > config.merge_min_share * static_cast<float>(area_px))
      labels.push_back(label);
  if (labels.size() < 2) labels.clear();
  return labels;
}

/// The segment's own super-point, into which all of it is fused, and what it shows of others.
std::vector<ShownLabel> shown_labels(const Votes& votes, int area_px, Label own, int min_votes) {
  std::map<Label, int> shown;
  for (const auto& [label, count] : votes)
    if (count > min_votes) shown[label] = count;
  shown[own] = area_px;
  std::vector<ShownLabel> result;
  for (const auto& [label, points] : shown) result.push_back({label, points});
  return result;
}

}  // namespace

void list_fields(AssociationConfig& config, ConfigFields& fields) {
  fields.add_choice<AssociationRule>("association", config.association,
                                     {{"one_to_one", AssociationRule::kOneToOne},
                                      {"argmax", AssociationRule::kArgmax},
                                      {"mixed", AssociationRule::kMixed}},
                                     "how segments take super-points");
  fields.add("assoc_min_votes", config.assoc_min_votes, 0, 1000000,
             "a super-point needs more votes than this, points");
  fields.add("assoc_min_share", config.assoc_min_share, 0.f, 1.f,
             "... and more than this share of the segment's points (0: the paper)");
  fields.add("merge_min_points", config.merge_min_points, 0, 100000000,
             "segments with more points tell what to merge");
  fields.add("merge_min_share", config.merge_min_share, 0.f, 1.f,
             "share of a segment's points a super-point must hold");
}

std::vector<SegmentAssociation> associate(const Segments& segments, const Image<VoxelRef>& surface,
                                          VoxelMap& map, const AssociationConfig& config) {
  const std::vector<Votes> votes = count_votes(segments, surface, map);
  std::vector<SegmentAssociation> result(segments.segments.size());
  if (config.association != AssociationRule::kArgmax) {
    OneToOne(segments, surface, map, config).assign(votes, result);
  } else {
    for (std::size_t i = 0; i < votes.size(); ++i) {
      const auto [label, count] = winner(votes[i]);
      if (count > votes_needed(segments.segments[i].area_px, config)) result[i].label = label;
    }
  }
  for (std::size_t i = 0; i < result.size(); ++i) {
    result[i].overlapped = overlapped_labels(votes[i], segments.segments[i].area_px, config);
    if (result[i].label == kNoLabel) {
      result[i].label = map.labels().create();
      result[i].founded = true;
    }
    const int area_px = segments.segments[i].area_px;
    result[i].shown =
        shown_labels(votes[i], area_px, result[i].label, votes_needed(area_px, config));
  }
  return result;
}

}  // namespace ovimap
