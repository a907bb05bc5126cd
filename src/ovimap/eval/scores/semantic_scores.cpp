// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/eval/scores/semantic_scores.h"

#include <algorithm>
#include <limits>

#include "ovimap/base/config.h"
#include "ovimap/eval/scores/average_precision.h"
#include "ovimap/eval/scores/panoptic_quality.h"

namespace ovimap {

namespace {

constexpr int kReferenceLastPercent = 90;

/// One scene's instances of all classes.
struct ClassedOverlaps {
  ScoredOverlaps all;  ///< `unlabelled`: vertices on void truth
  InstanceClasses classes;
};

/// Only the instances of one class, sizes and overlaps unchanged.
ScoredOverlaps of_class(const ClassedOverlaps& scene, std::int32_t class_number,
                        std::int64_t min_predicted_vertices) {
  constexpr std::size_t kLeftOut = std::numeric_limits<std::size_t>::max();
  const InstanceOverlaps& all = scene.all.table;
  ScoredOverlaps result;
  std::vector<std::size_t> new_truth(all.truth.size(), kLeftOut),
      new_predicted(all.predicted.size(), kLeftOut);
  for (std::size_t t = 0; t < all.truth.size(); ++t) {
    if (scene.classes.truth[t] != class_number) continue;
    new_truth[t] = result.table.truth.size();
    result.table.truth.push_back(all.truth[t]);
  }
  for (std::size_t p = 0; p < all.predicted.size(); ++p) {
    if (scene.classes.predicted[p] != class_number ||
        all.predicted[p].vertices < min_predicted_vertices)
      continue;
    new_predicted[p] = result.table.predicted.size();
    result.table.predicted.push_back(all.predicted[p]);
    result.table.unlabelled.push_back(all.unlabelled[p]);
    result.confidence.push_back(scene.all.confidence[p]);
  }
  for (InstanceOverlap overlap : all.overlaps) {
    overlap.truth = new_truth[overlap.truth];
    overlap.predicted = new_predicted[overlap.predicted];
    if (overlap.truth != kLeftOut && overlap.predicted != kLeftOut)
      result.table.overlaps.push_back(overlap);
  }
  return result;
}

/// Standard protocol: what no truth instance with a class covers is void.
ClassedOverlaps standard_overlaps(const SemanticScene& scene, int class_count) {
  ClassedOverlaps result;
  InstanceOverlaps& table = result.all.table;
  table =
      count_overlaps(scene.instances.truth, scene.instances.predicted, Background::kNotPositive);
  result.classes = instance_classes(scene, table, class_count, TruthClassRule::kMajority);
  for (const InstanceOverlap& overlap : table.overlaps)
    if (result.classes.truth[overlap.truth] == 0)
      table.unlabelled[overlap.predicted] += overlap.shared;
  for (const InstanceSize& instance : table.predicted)
    result.all.confidence.push_back(confidence_of(scene.instances, instance));
  return result;
}

/// Reference protocol: void is where the truth has no class that has instances.
ClassedOverlaps reference_overlaps(const SemanticScene& scene, const std::vector<bool>& scored) {
  const int class_count = static_cast<int>(scored.size()) - 1;
  ClassedOverlaps result;
  InstanceOverlaps& table = result.all.table;
  table = count_overlaps(scene.instances.truth, scene.instances.predicted, Background::kLowestId);
  result.classes = instance_classes(scene, table, class_count, TruthClassRule::kHighest);
  std::map<std::int64_t, std::int64_t> void_vertices;
  const std::vector<std::int32_t> truth = vertex_classes(scene, class_count).truth;
  for (std::size_t v = 0; v < truth.size(); ++v)
    if (!scored[static_cast<std::size_t>(truth[v])]) ++void_vertices[scene.instances.predicted[v]];
  std::map<std::int32_t, std::int64_t> largest;
  for (std::size_t p = 0; p < table.predicted.size(); ++p) {
    std::int64_t& size = largest[result.classes.predicted[p]];
    size = std::max(size, table.predicted[p].vertices);
    table.unlabelled[p] = void_vertices[table.predicted[p].id];
  }
  for (std::size_t p = 0; p < table.predicted.size(); ++p)
    result.all.confidence.push_back(static_cast<double>(table.predicted[p].vertices) /
                                    static_cast<double>(largest.at(result.classes.predicted[p])));
  return result;
}

/// IoU and accuracy from the confusion matrix of all scenes. Only its diagonal and its sums matter.
std::vector<ClassScores> confusion_scores(std::span<const SemanticScene> scenes, int class_count) {
  const auto size = static_cast<std::size_t>(class_count) + 1;
  std::vector<std::int64_t> truth(size), predicted(size), right(size);
  for (const SemanticScene& scene : scenes) {
    const VertexClasses classes = vertex_classes(scene, class_count);
    for (std::size_t v = 0; v < classes.truth.size(); ++v) {
      const auto t = static_cast<std::size_t>(classes.truth[v]);
      const auto p = static_cast<std::size_t>(classes.predicted[v]);
      if (t == 0) continue;
      ++truth[t], ++predicted[p];
      right[t] += t == p;
    }
  }
  std::vector<ClassScores> scores(size - 1);
  for (std::size_t c = 1; c < size; ++c) {
    ClassScores& score = scores[c - 1];
    score.class_number = static_cast<std::int32_t>(c);
    score.truth_vertices = truth[c], score.predicted_vertices = predicted[c];
    if (truth[c] == 0) continue;
    score.iou =
        static_cast<double>(right[c]) / static_cast<double>(truth[c] + predicted[c] - right[c]);
    score.accuracy = static_cast<double>(right[c]) / static_cast<double>(truth[c]);
  }
  return scores;
}

std::vector<ScoredOverlaps> of_class(std::span<const ClassedOverlaps> scenes,
                                     std::int32_t class_number, std::int64_t min_vertices) {
  std::vector<ScoredOverlaps> result;
  for (const ClassedOverlaps& scene : scenes)
    result.push_back(of_class(scene, class_number, min_vertices));
  return result;
}

/// `precision_at(percent)` at the thresholds of a protocol.
template <class PrecisionAt>
void fill_precision(ClassScores& score, int last_percent, const PrecisionAt& precision_at) {
  score.ap25 = precision_at(25), score.ap50 = precision_at(50), score.ap75 = precision_at(75);
  score.ap = mean_precision(last_percent, precision_at);
}

/// The mean of a figure over the classes that have it.
double mean(std::span<const ClassScores* const> classes,
            std::optional<double> ClassScores::*figure) {
  double sum = 0;
  int count = 0;
  for (const ClassScores* score : classes)
    if (const auto& value = score->*figure) sum += *value, ++count;
  return count > 0 ? sum / count : 0;
}

SemanticScores means(std::span<const ClassScores* const> classes) {
  SemanticScores scores;
  double truth_vertices = 0;
  for (const ClassScores* score : classes) {
    scores.classes += score->iou.has_value();
    scores.instance_classes += score->ap.has_value();
    truth_vertices += static_cast<double>(score->truth_vertices);
    scores.fwiou += static_cast<double>(score->truth_vertices) * score->iou.value_or(0);
  }
  if (truth_vertices > 0) scores.fwiou /= truth_vertices;
  scores.miou = mean(classes, &ClassScores::iou);
  scores.macc = mean(classes, &ClassScores::accuracy);
  scores.ap25 = mean(classes, &ClassScores::ap25);
  scores.ap50 = mean(classes, &ClassScores::ap50);
  scores.ap75 = mean(classes, &ClassScores::ap75);
  scores.ap = mean(classes, &ClassScores::ap);
  scores.pq = mean(classes, &ClassScores::pq);
  scores.sq = mean(classes, &ClassScores::sq);
  scores.rq = mean(classes, &ClassScores::rq);
  return scores;
}

}  // namespace

void list_fields(SemanticReferenceConfig& config, ConfigFields& fields) {
  fields.add("min_vertices", config.min_vertices, 1, 1000000,
             "instances with fewer truth vertices have no average precision in the reference "
             "protocol");
}

std::vector<ClassScores> standard_class_scores(std::span<const SemanticScene> scenes,
                                               const SemanticClasses& classes) {
  std::vector<ClassScores> scores = confusion_scores(scenes, classes.count);
  const std::vector<PanopticCounts> panoptic = panoptic_counts(scenes, classes);
  std::vector<ClassedOverlaps> overlaps;
  for (const SemanticScene& scene : scenes)
    overlaps.push_back(standard_overlaps(scene, classes.count));
  for (std::size_t c = 0; c < scores.size(); ++c) {
    if (panoptic[c].segments() > 0) {
      scores[c].pq = panoptic[c].quality();
      scores[c].sq = panoptic[c].segmentation_quality();
      scores[c].rq = panoptic[c].recognition_quality();
    }
    const auto tables = of_class(overlaps, scores[c].class_number, 0);
    if (std::all_of(tables.begin(), tables.end(),
                    [](const auto& s) { return s.table.truth.empty(); }))
      continue;
    fill_precision(scores[c], kLastPercent, [&](int percent) {
      return ranked_precision(tables, percent).average_precision;
    });
  }
  return scores;
}

std::vector<ClassScores> reference_class_scores(std::span<const SemanticScene> scenes,
                                                const SemanticClasses& classes,
                                                const SemanticReferenceConfig& config) {
  std::vector<ClassScores> scores = confusion_scores(scenes, classes.count);
  std::vector<bool> scored(scores.size() + 1, true);
  scored[0] = false;
  for (const std::int32_t stuff : classes.stuff) scored[static_cast<std::size_t>(stuff)] = false;
  std::vector<ClassedOverlaps> overlaps;
  for (const SemanticScene& scene : scenes) overlaps.push_back(reference_overlaps(scene, scored));
  for (ClassScores& score : scores) {
    if (!scored[static_cast<std::size_t>(score.class_number)]) continue;
    const auto tables = of_class(overlaps, score.class_number, config.min_vertices);
    const auto precision_at = [&](int percent) {
      return benchmark_precision(tables, percent, config.min_vertices);
    };
    if (!precision_at(kFirstPercent)) continue;
    fill_precision(score, kReferenceLastPercent,
                   [&](int percent) { return precision_at(percent).value_or(0); });
  }
  return scores;
}

SemanticScores mean_scores(std::span<const ClassScores> classes) {
  std::vector<const ClassScores*> all;
  for (const ClassScores& score : classes) all.push_back(&score);
  return means(all);
}

SemanticScores mean_scores(std::span<const ClassScores> classes,
                           std::span<const std::int32_t> group) {
  std::vector<const ClassScores*> chosen;
  for (const ClassScores& score : classes)
    if (std::find(group.begin(), group.end(), score.class_number) != group.end())
      chosen.push_back(&score);
  return means(chosen);
}

LabelledScene without_instances(LabelledScene scene, std::span<const std::uint32_t> dropped) {
  std::vector<std::uint32_t> ids(dropped.begin(), dropped.end());
  std::sort(ids.begin(), ids.end());
  for (std::uint32_t& id : scene.predicted)
    if (std::binary_search(ids.begin(), ids.end(), id)) id = 0;
  return scene;
}

}  // namespace ovimap
