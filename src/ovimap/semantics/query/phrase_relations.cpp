// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <tuple>

#include "ovimap/base/error.h"
#include "ovimap/base/parallel.h"
#include "ovimap/semantics/query/attribute_rating.h"
#include "ovimap/semantics/query/query_scene.h"

namespace ovimap {

namespace {

constexpr std::size_t kObjectsPerTask = 4;

/// Given objects in order of preference: the chance of each that it fits and none before it does.
void first_that_fits(const std::vector<std::size_t>& ordered, const Eigen::VectorXf& chances,
                     Eigen::VectorXf& result) {
  float none_before = 1.f;
  for (const std::size_t i : ordered) {
    const auto row = static_cast<Eigen::Index>(i);
    result[row] = chances[row] * none_before;
    none_before *= 1.f - chances[row];
  }
}

}  // namespace

std::vector<std::size_t> PhraseSearch::anchors_of(const PhraseMatch& match) const {
  std::vector<std::size_t> anchors = match.possible();
  std::sort(anchors.begin(), anchors.end(), [&](std::size_t a, std::size_t b) {
    return std::tuple(-match.score(a), id_of(a)) < std::tuple(-match.score(b), id_of(b));
  });
  anchors.resize(std::min(anchors.size(), static_cast<std::size_t>(config_.max_anchors)));
  return anchors;
}

PhraseSearch::PairRating PhraseSearch::rate_pairs(const QueryPhrase& phrase, std::size_t object,
                                                  std::span<const BoxedAnchor> near,
                                                  const PhraseMatch& anchors) const {
  const std::vector<ObjectShape>& shapes = scene_.shapes.whole();
  const Eigen::AlignedBox3f box = upright_box(shapes[object]);
  std::vector<std::pair<float, std::size_t>> bounds;  // no rating is higher, rank in `near`
  for (std::size_t rank = 0; rank < near.size(); ++rank)
    bounds.emplace_back(highest_rating(*phrase.relation, box, near[rank].box, config_.relations),
                        rank);
  // What may be best comes first, so that most others need not be rated.
  std::sort(bounds.begin(), bounds.end(), [&](const auto& a, const auto& b) {
    return std::tuple(-a.first * anchors.score(near[a.second].position), a.second) <
           std::tuple(-b.first * anchors.score(near[b.second].position), b.second);
  });
  PairRating best;
  std::size_t best_rank = near.size();
  for (const auto& [bound, rank] : bounds) {
    const std::size_t j = near[rank].position;
    if (j == object) continue;
    const auto beats = [&](float score) {
      return std::tuple(score, best_rank) > std::tuple(best.score, rank);
    };
    const bool may_hold = !best.holds && anchors.holds[j] && bound >= kRelationHolds;
    if (!beats(bound * anchors.score(j)) && !may_hold) continue;
    const RelationRating rating = rate_relation(*phrase.relation, shapes[object], shapes[j],
                                                id_of(j), scene_.viewpoint, config_.relations);
    if (rating.score >= kRelationHolds && anchors.holds[j]) best.holds = true;
    const float score = anchors.score(j) * rating.score;
    if (!beats(score)) continue;
    best.score = score;
    best_rank = rank;
    best.evidence = with_anchor(rating.evidence, anchors.evidence[j]);
    if (phrase.negated)
      best.evidence = concat("not ", relation_name(*phrase.relation), " #", id_of(j), " (",
                             rating.evidence, ")");
  }
  return best;
}

void PhraseSearch::apply_pairs(const QueryPhrase& phrase, const PhraseMatch& anchors,
                               PhraseMatch& result) const {
  const std::vector<std::size_t> candidates = result.possible();
  std::vector<BoxedAnchor> near;
  for (const std::size_t j : anchors_of(anchors))
    near.push_back({j, upright_box(scene_.shapes.outline(j))});
  (void)scene_.shapes.whole();                // read before the loop, which must not
  std::vector<char> holds(index_.size(), 0);  // vector<bool> cannot be written in parallel
  parallel_for(candidates.size(), kObjectsPerTask, [&](std::size_t k) {
    const std::size_t i = candidates[k];
    PairRating best = rate_pairs(phrase, i, near, anchors);
    result.score(i) *= phrase.negated ? 1.f - best.score : best.score;
    result.evidence[i] = std::move(best.evidence);
    holds[i] = best.holds ? 1 : 0;
  });
  for (const std::size_t i : candidates)
    result.holds[i] = result.holds[i] && (holds[i] != 0) != phrase.negated;
}

void PhraseSearch::apply_order(const QueryPhrase& phrase, const PhraseMatch& anchors,
                               PhraseMatch& result) const {
  const std::vector<ObjectShape>& shapes = scene_.shapes.whole();
  const bool nearest = *phrase.relation == Relation::kNearest;
  const std::vector<std::size_t> candidates = result.possible();
  const Eigen::VectorXf chances = result.scores;
  const std::vector<bool> things_hold = result.holds;
  result.scores.setZero();
  for (const std::size_t j : anchors_of(anchors)) {
    std::vector<std::size_t> ordered = candidates;
    std::erase(ordered, j);
    std::vector<float> gaps(index_.size()), centres(index_.size());
    parallel_for(ordered.size(), kObjectsPerTask, [&](std::size_t k) {
      const ObjectShape &a = shapes[ordered[k]], &b = shapes[j];
      const float sign = nearest ? 1.f : -1.f;
      gaps[ordered[k]] = sign * gap_m(a, b);
      centres[ordered[k]] = sign * (a.centroid - b.centroid).norm();
    });
    std::sort(ordered.begin(), ordered.end(), [&](std::size_t a, std::size_t b) {
      return std::tuple(gaps[a], centres[a], id_of(a)) < std::tuple(gaps[b], centres[b], id_of(b));
    });
    Eigen::VectorXf scores = Eigen::VectorXf::Zero(chances.size());
    first_that_fits(ordered, chances, scores);
    for (const std::size_t i : ordered) {
      const float score = scores[static_cast<Eigen::Index>(i)] * anchors.score(j);
      if (score <= result.score(i)) continue;
      result.score(i) = score;
      result.holds[i] = things_hold[i] && anchors.holds[j];
      const auto rating = rate_relation(Relation::kNear, shapes[i], shapes[j], id_of(j),
                                        scene_.viewpoint, config_.relations);
      result.evidence[i] = with_anchor(rating.evidence, anchors.evidence[j]);
    }
  }
}

void PhraseSearch::apply_between(const PhraseMatch& first, const PhraseMatch& second,
                                 bool same_kind, PhraseMatch& result) const {
  const std::vector<ObjectShape>& shapes = scene_.shapes.whole();
  const std::vector<std::size_t> left = anchors_of(first), right = anchors_of(second);
  for (const std::size_t i : result.possible()) {
    float best = 0.f;
    bool holds = false;
    for (const std::size_t j : left)
      for (const std::size_t k : right) {
        if (i == j || i == k || j == k || (same_kind && k < j)) continue;
        const auto rating = rate_between(shapes[i], shapes[j], shapes[k], id_of(j), id_of(k));
        const float score = first.score(j) * second.score(k) * rating.score;
        holds = holds || (rating.score >= kRelationHolds && first.holds[j] && second.holds[k]);
        if (score <= best) continue;
        best = score;
        result.evidence[i] = rating.evidence;
      }
    result.score(i) *= best;
    result.holds[i] = result.holds[i] && holds;
  }
}

void PhraseSearch::apply_superlative(Superlative superlative, PhraseMatch& result) const {
  std::vector<std::size_t> ordered = result.possible();
  std::vector<SuperlativeMeasure> measures(index_.size());
  for (const std::size_t i : ordered) measures[i] = measure(superlative, scene_.shapes.outline(i));
  std::sort(ordered.begin(), ordered.end(), [&](std::size_t a, std::size_t b) {
    return std::tuple(-measures[a].value, id_of(a)) < std::tuple(-measures[b].value, id_of(b));
  });
  const Eigen::VectorXf chances = result.scores;
  first_that_fits(ordered, chances, result.scores);
  for (const std::size_t i : ordered) add_evidence(result.evidence[i], measures[i].evidence);
}

}  // namespace ovimap
