// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/eval/scenes/overlap.h"

#include <algorithm>

#include "ovimap/base/error.h"

namespace ovimap {

namespace {

/// Below this or at it a truth id is background.
std::int64_t highest_background(std::span<const std::int32_t> truth, Background background) {
  if (background == Background::kNotPositive || truth.empty()) return 0;
  return *std::min_element(truth.begin(), truth.end());
}

std::vector<InstanceSize> instance_sizes(std::vector<std::int64_t> ids) {
  std::sort(ids.begin(), ids.end());
  std::vector<InstanceSize> sizes;
  for (const std::int64_t id : ids) {
    if (sizes.empty() || sizes.back().id != id) sizes.push_back({id, 0});
    ++sizes.back().vertices;
  }
  return sizes;
}

std::size_t position_of(const std::vector<InstanceSize>& instances, std::int64_t id) {
  const auto found = std::lower_bound(
      instances.begin(), instances.end(), id,
      [](const InstanceSize& instance, std::int64_t wanted) { return instance.id < wanted; });
  return static_cast<std::size_t>(found - instances.begin());
}

}  // namespace

std::span<const InstanceOverlap> InstanceOverlaps::of_predicted(
    std::size_t predicted_position) const {
  const auto [begin, end] = std::equal_range(
      overlaps.begin(), overlaps.end(), InstanceOverlap{0, predicted_position},
      [](const InstanceOverlap& a, const InstanceOverlap& b) { return a.predicted < b.predicted; });
  return {begin, end};
}

InstanceOverlaps count_overlaps(std::span<const std::int32_t> truth,
                                std::span<const std::uint32_t> predicted, Background background) {
  OVIMAP_ASSERT(truth.size() == predicted.size());
  const std::int64_t no_truth = highest_background(truth, background);
  struct Pair {
    std::int64_t predicted, truth;
    bool operator==(const Pair&) const = default;
    auto operator<=>(const Pair&) const = default;
  };
  std::vector<std::int64_t> truth_ids, predicted_ids;
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (truth[i] > no_truth) truth_ids.push_back(truth[i]);
    if (predicted[i] != 0) predicted_ids.push_back(predicted[i]);
    if (truth[i] > no_truth && predicted[i] != 0) pairs.push_back({predicted[i], truth[i]});
  }
  InstanceOverlaps table{
      instance_sizes(std::move(truth_ids)), instance_sizes(std::move(predicted_ids)), {}, {}};
  std::sort(pairs.begin(), pairs.end());
  for (auto begin = pairs.begin(); begin != pairs.end();) {
    const auto end = std::upper_bound(begin, pairs.end(), *begin);
    table.overlaps.push_back({position_of(table.truth, begin->truth),
                              position_of(table.predicted, begin->predicted), end - begin, 0});
    begin = end;
  }
  for (const InstanceSize& instance : table.predicted)
    table.unlabelled.push_back(instance.vertices);
  for (InstanceOverlap& overlap : table.overlaps) {
    overlap.united = table.truth[overlap.truth].vertices +
                     table.predicted[overlap.predicted].vertices - overlap.shared;
    table.unlabelled[overlap.predicted] -= overlap.shared;
  }
  return table;
}

}  // namespace ovimap
