// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/alignment/map_alignment.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "ovimap/base/config.h"
#include "ovimap/base/parallel.h"
#include "ovimap/map/surface/mesh_extraction.h"
#include "ovimap/pipeline/alignment/surface_fit.h"

namespace ovimap {

namespace {

// Proposals are fitted and judged roughly; the best of them once more, by all that is known.
constexpr std::array kFarReaches_m = {0.4f, 0.2f};
constexpr std::array kNearReaches_m = {0.2f, 0.1f, 0.06f};
constexpr int kFarRounds = 6, kNearRounds = 8;
constexpr double kSameShift_m = 0.2, kSameTurn_rad = 0.1;
constexpr float kRoughSpacing = 2;  // as large as the fine one
constexpr int kRoughViews = 12;
constexpr std::size_t kFineAnswers = 6;

PlaceAgreement sum_of(const std::vector<PlaceView>& views, const VoxelMap& map,
                      const Pose& map_from_world, const PlaceConfig& config) {
  std::vector<PlaceAgreement> each(views.size());
  parallel_for(views.size(), 1, [&](std::size_t i) {
    each[i] = agreement(views[i], map, map_from_world * views[i].world_from_camera, config);
  });
  PlaceAgreement sum;
  for (const PlaceAgreement& one : each) sum += one;
  return sum;
}

PlaceConfig rough(PlaceConfig config) {
  config.max_views = std::min(config.max_views, kRoughViews);
  return config;
}

/// Holds what the cameras of each of two maps saw against the other.
class Judge {
 public:
  Judge(const MapDocument& a, const MapDocument& b, const PlaceConfig& config)
      : a_(a),
        b_(b),
        config_(config),
        views_a_(place_views(a, config)),
        views_b_(place_views(b, config)) {}

  /// Gives an answer's overlap and fit.
  void operator()(MapAlignment& answer) const {
    const PlaceAgreement of_b = sum_of(views_b_, a_.map, answer.a_from_b, config_),
                         of_a = sum_of(views_a_, b_.map, answer.a_from_b.inverse(), config_);
    answer.overlap = static_cast<float>(std::max(of_a.overlap(), of_b.overlap()));
    PlaceAgreement both = of_a;
    both += of_b;
    const double judged = both.meeting + both.seen_through;
    answer.fit = judged > 0 ? static_cast<float>(both.meeting / judged) : 0.f;
  }

 private:
  const MapDocument &a_, &b_;
  PlaceConfig config_;
  std::vector<PlaceView> views_a_, views_b_;
};

/// Whether two answers put what b saw at one place; `middle_of_b`: of where its cameras stood.
class SameAnswer {
 public:
  explicit SameAnswer(const MapDocument& b) {
    for (const FrameLogEntry& frame : b.frames)
      middle_of_b_ += frame.world_from_camera.translation() / static_cast<double>(b.frames.size());
  }
  bool operator()(const Pose& x, const Pose& y, double shift_m, double turn_rad) const {
    return (x * middle_of_b_ - y * middle_of_b_).norm() < shift_m &&
           Eigen::AngleAxisd((x.inverse() * y).linear()).angle() < turn_rad;
  }

 private:
  Eigen::Vector3d middle_of_b_ = Eigen::Vector3d::Zero();
};

/// Poses that proposals lead to, fitted roughly, each once.
std::vector<MapAlignment> rough_answers(const std::vector<LayoutProposal>& proposals,
                                        const SurfaceFit& fit, const SameAnswer& same) {
  constexpr double kOneShift_m = 0.05, kOneTurn_rad = 0.03;
  std::vector<MapAlignment> answers;
  for (const LayoutProposal& proposal : proposals) {
    const Pose pose = fit.refine(proposal.a_from_b, kFarReaches_m, kFarRounds);
    const auto known = std::find_if(answers.begin(), answers.end(), [&](const MapAlignment& other) {
      return same(pose, other.a_from_b, kOneShift_m, kOneTurn_rad);
    });
    if (known == answers.end())
      answers.push_back({.a_from_b = pose, .objects = proposal.objects});
    else
      known->objects = std::max(known->objects, proposal.objects);
  }
  return answers;
}

void sort_best_first(std::vector<MapAlignment>& answers) {
  std::stable_sort(answers.begin(), answers.end(),
                   [](const auto& x, const auto& y) { return x.score() > y.score(); });
}

std::string share(float value) {
  return std::to_string(std::lround(100 * value)) + " %";
}

std::string doubt_of(const MapAlignment& best, const AlignmentConfig& config) {
  const bool clear = best.runner_up < 0.5f * best.score();
  const char* why = nullptr;
  if (best.objects < config.min_objects)
    why = "too few objects say so";
  else if (best.overlap < config.min_overlap)
    why = "too little of their surfaces would meet";
  else if (best.fit < (clear ? config.min_clear_fit : config.min_fit))
    why = "they would contradict each other";
  else if (best.score() - best.runner_up < config.min_lead * best.score())
    why = "another answer fits as well";
  if (why == nullptr) return {};
  return concat(why, " (objects ", best.objects, ", overlap ", share(best.overlap), ", fit ",
                share(best.fit), ", next best ",
                share(best.score() > 0 ? best.runner_up / best.score() : 1.f), " of it)");
}

}  // namespace

void list_fields(AlignmentConfig& config, ConfigFields& fields) {
  fields.add("min_overlap", config.min_overlap, 0.f, 1.f, "of what cameras saw that must meet");
  fields.add("min_fit", config.min_fit, 0.f, 1.f, "of surface where both looked that must agree");
  fields.add("min_clear_fit", config.min_clear_fit, 0.f, 1.f,
             "the same where the next other answer is not half as good");
  fields.add("min_lead", config.min_lead, 0.f, 1.f, "over the next other answer, as a share");
  fields.add("min_objects", config.min_objects, 0, 1000, "that must speak for the answer");
  fields.add("spacing_m", config.spacing_m, 0.001f, 1.f, "between fitted surface points, metres");
  fields.group("layout", [&](ConfigFields& group) { list_fields(config.layout, group); });
  fields.group("place", [&](ConfigFields& group) { list_fields(config.place, group); });
}

MapAlignment judge_alignment(const MapDocument& a, const MapDocument& b, const Pose& a_from_b,
                             const AlignmentConfig& config) {
  MapAlignment answer{.a_from_b = a_from_b};
  Judge(a, b, config.place)(answer);
  return answer;
}

std::vector<MapAlignment> alignments(const MapDocument& a, const MapDocument& b,
                                     const AlignmentConfig& config) {
  const auto proposals = propose_poses(layout_of(a), layout_of(b), config.layout);
  const SameAnswer same(b);
  const Mesh mesh_a = extract_mesh(a.map), mesh_b = extract_mesh(b.map);
  std::vector<MapAlignment> answers;
  {
    const float spacing_m = kRoughSpacing * config.spacing_m;
    const SurfacePoints surface_a = thinned_surface(mesh_a, spacing_m),
                        surface_b = thinned_surface(mesh_b, spacing_m);
    answers = rough_answers(proposals, SurfaceFit(surface_a, surface_b), same);
    const Judge judge(a, b, rough(config.place));
    for (MapAlignment& answer : answers) judge(answer);
    sort_best_first(answers);
  }
  const SurfacePoints surface_a = thinned_surface(mesh_a, config.spacing_m),
                      surface_b = thinned_surface(mesh_b, config.spacing_m);
  const SurfaceFit fit(surface_a, surface_b);
  const Judge judge(a, b, config.place);
  for (MapAlignment& answer : std::span(answers).first(std::min(answers.size(), kFineAnswers))) {
    answer.a_from_b = fit.refine(answer.a_from_b, kNearReaches_m, kNearRounds);
    judge(answer);
  }
  sort_best_first(answers);
  return answers;
}

AlignmentSearch search_alignment(const MapDocument& a, const MapDocument& b,
                                 const AlignmentConfig& config) {
  const std::vector<MapAlignment> answers = alignments(a, b, config);
  if (answers.empty()) return {{}, "too few objects are alike"};
  AlignmentSearch search{answers.front(), {}};
  const SameAnswer same(b);
  for (const MapAlignment& other : answers)
    if (same(other.a_from_b, search.best.a_from_b, kSameShift_m, kSameTurn_rad))
      search.best.objects = std::max(search.best.objects, other.objects);
    else
      search.best.runner_up = std::max(search.best.runner_up, other.score());
  search.doubt = doubt_of(search.best, config);
  return search;
}

MapAlignment align_maps(const MapDocument& a, const MapDocument& b, const AlignmentConfig& config) {
  const AlignmentSearch search = search_alignment(a, b, config);
  if (!search.doubt.empty())
    throw Error(concat("the maps cannot be aligned with confidence: ", search.doubt,
                       "; give the transform with --transform FILE"));
  return search.best;
}

}  // namespace ovimap
