// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/eval/scores/panoptic_quality.h"

#include <algorithm>
#include <map>

#include "ovimap/eval/scenes/overlap.h"

namespace ovimap {

namespace {

/// Numbers segments of one side from 1 on; 0 is no segment.
class SegmentNumbers {
 public:
  explicit SegmentNumbers(const SemanticClasses& classes) : is_stuff_(classes.count + 1, false) {
    for (const std::int32_t c : classes.stuff) is_stuff_.at(static_cast<std::size_t>(c)) = true;
  }

  std::int32_t number(std::int64_t instance, std::int32_t class_number) {
    if (class_number == 0) return 0;
    const bool stuff = is_stuff_[static_cast<std::size_t>(class_number)];
    if (!stuff && instance <= 0) return 0;
    const auto [at, is_new] = numbers_.try_emplace({class_number, stuff ? 0 : instance},
                                                   static_cast<std::int32_t>(classes_.size()));
    if (is_new) classes_.push_back(class_number);
    return at->second;
  }

  std::int32_t class_of(std::int64_t segment) const {
    return classes_[static_cast<std::size_t>(segment)];
  }

 private:
  std::vector<bool> is_stuff_;
  std::map<std::pair<std::int32_t, std::int64_t>, std::int32_t> numbers_;
  std::vector<std::int32_t> classes_ = {0};  // by segment number
};

/// Truth instances speak with one class; a vertex outside of all instances with its own.
std::vector<std::int32_t> truth_classes_of_vertices(const SemanticScene& scene, int class_count) {
  const std::vector<std::int32_t>& ids = scene.instances.truth;
  const InstanceOverlaps table =
      count_overlaps(ids, scene.instances.predicted, Background::kNotPositive);
  const InstanceClasses of_instances =
      instance_classes(scene, table, class_count, TruthClassRule::kMajority);
  std::map<std::int64_t, std::int32_t> by_id;
  for (std::size_t t = 0; t < table.truth.size(); ++t)
    by_id[table.truth[t].id] = of_instances.truth[t];
  std::vector<std::int32_t> classes = vertex_classes(scene, class_count).truth;
  for (std::size_t v = 0; v < classes.size(); ++v)
    if (ids[v] > 0) classes[v] = by_id.at(ids[v]);
  return classes;
}

struct Segments {
  InstanceOverlaps table;
  std::vector<std::int32_t> truth_class, predicted_class;  // per position in the table
};

Segments segments_of(const SemanticScene& scene, const SemanticClasses& classes) {
  const std::size_t count = scene.truth_classes.size();
  const std::vector<std::int32_t> truth_class = truth_classes_of_vertices(scene, classes.count);
  const std::vector<std::int32_t> predicted_class = vertex_classes(scene, classes.count).predicted;
  SegmentNumbers truth_numbers(classes), predicted_numbers(classes);
  std::vector<std::int32_t> truth(count);
  std::vector<std::uint32_t> predicted(count);
  for (std::size_t v = 0; v < count; ++v) {
    truth[v] = truth_numbers.number(scene.instances.truth[v], truth_class[v]);
    predicted[v] = static_cast<std::uint32_t>(
        predicted_numbers.number(scene.instances.predicted[v], predicted_class[v]));
  }
  Segments segments{count_overlaps(truth, predicted, Background::kNotPositive), {}, {}};
  for (const InstanceSize& segment : segments.table.truth)
    segments.truth_class.push_back(truth_numbers.class_of(segment.id));
  for (const InstanceSize& segment : segments.table.predicted)
    segments.predicted_class.push_back(predicted_numbers.class_of(segment.id));
  return segments;
}

void count_segments(const Segments& segments, std::vector<PanopticCounts>& counts) {
  const InstanceOverlaps& table = segments.table;
  const auto of_class = [&](std::int32_t c) -> PanopticCounts& {
    return counts[static_cast<std::size_t>(c - 1)];
  };
  std::vector<bool> truth_matched(table.truth.size()), matched(table.predicted.size());
  for (const InstanceOverlap& overlap : table.overlaps) {
    const std::int32_t c = segments.truth_class[overlap.truth];
    const std::int64_t united = overlap.united - table.unlabelled[overlap.predicted];
    if (c != segments.predicted_class[overlap.predicted] || 2 * overlap.shared <= united) continue;
    truth_matched[overlap.truth] = matched[overlap.predicted] = true;
    ++of_class(c).right;
    of_class(c).iou_sum += static_cast<double>(overlap.shared) / static_cast<double>(united);
  }
  for (std::size_t t = 0; t < table.truth.size(); ++t)
    if (!truth_matched[t]) ++of_class(segments.truth_class[t]).missed;
  for (std::size_t p = 0; p < table.predicted.size(); ++p)
    if (!matched[p] && 2 * table.unlabelled[p] <= table.predicted[p].vertices)
      ++of_class(segments.predicted_class[p]).wrong;
}

}  // namespace

double PanopticCounts::segmentation_quality() const {
  return right > 0 ? iou_sum / right : 0;
}

double PanopticCounts::recognition_quality() const {
  return segments() > 0 ? right / (right + 0.5 * wrong + 0.5 * missed) : 0;
}

std::vector<PanopticCounts> panoptic_counts(std::span<const SemanticScene> scenes,
                                            const SemanticClasses& classes) {
  std::vector<PanopticCounts> counts(static_cast<std::size_t>(classes.count));
  for (const SemanticScene& scene : scenes) count_segments(segments_of(scene, classes), counts);
  return counts;
}

}  // namespace ovimap
