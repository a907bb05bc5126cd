// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/alignment/map_alignment.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "ovimap/base/config.h"
#include "ovimap/base/parallel.h"
#include "ovimap/pipeline/alignment/surface_fit.h"

namespace ovimap {

namespace {

constexpr std::array kFarReaches_m = {0.4f, 0.2f, 0.1f}, kNearReaches_m = {0.2f, 0.1f, 0.06f};
constexpr int kFarRounds = 6, kNearRounds = 10;

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

/// Holds what the cameras of each of two maps saw against the other.
class Judge {
 public:
  Judge(const MapDocument& a, const MapDocument& b, const PlaceConfig& config)
      : a_(a), b_(b), config_(config), views_a_(place_views(a, config)),
        views_b_(place_views(b, config)) {}

  MapAlignment operator()(const Pose& a_from_b) const {
    const PlaceAgreement of_b = sum_of(views_b_, a_.map, a_from_b, config_),
                         of_a = sum_of(views_a_, b_.map, a_from_b.inverse(), config_);
    MapAlignment result;
    result.a_from_b = a_from_b;
    result.overlap = static_cast<float>(std::max(of_a.overlap(), of_b.overlap()));
    PlaceAgreement both = of_a;
    both += of_b;
    const double judged = both.meeting + both.seen_through;
    result.fit = judged > 0 ? static_cast<float>(both.meeting / judged) : 0.f;
    return result;
  }

 private:
  const MapDocument &a_, &b_;
  PlaceConfig config_;
  std::vector<PlaceView> views_a_, views_b_;
};

bool same_answer(const Pose& x, const Pose& y) {
  constexpr double kSameShift_m = 0.2, kSameTurn_rad = 0.1;
  const Pose between = x.inverse() * y;
  return between.translation().norm() < kSameShift_m &&
         Eigen::AngleAxisd(between.linear()).angle() < kSameTurn_rad;
}

std::string share(float value) {
  return std::to_string(std::lround(100 * value)) + " %";
}

std::string doubt_of(const MapAlignment& best, const AlignmentConfig& config) {
  const bool clear = best.runner_up < 0.5f * best.score();
  const char* why = nullptr;
  if (best.overlap < config.min_overlap)
    why = "too little of their surfaces would meet";
  else if (best.fit < (clear ? config.min_clear_fit : config.min_fit))
    why = "they would contradict each other";
  else if (best.score() - best.runner_up < config.min_lead * best.score())
    why = "another answer fits as well";
  if (why == nullptr) return {};
  return concat(why, " (overlap ", share(best.overlap), ", fit ", share(best.fit), ", next best ",
                share(best.score() > 0 ? best.runner_up / best.score() : 1.f), " of it)");
}

}  // namespace

void list_fields(AlignmentConfig& config, ConfigFields& fields) {
  fields.add("min_overlap", config.min_overlap, 0.f, 1.f, "of what cameras saw that must meet");
  fields.add("min_fit", config.min_fit, 0.f, 1.f, "of surface where both looked that must agree");
  fields.add("min_clear_fit", config.min_clear_fit, 0.f, 1.f,
             "the same where the next other answer is not half as good");
  fields.add("min_lead", config.min_lead, 0.f, 1.f, "over the next other answer, as a share");
  fields.add("spacing_m", config.spacing_m, 0.001f, 1.f, "between fitted surface points, metres");
  fields.group("layout", [&](ConfigFields& group) { list_fields(config.layout, group); });
  fields.group("place", [&](ConfigFields& group) { list_fields(config.place, group); });
}

MapAlignment judge_alignment(const MapDocument& a, const MapDocument& b, const Pose& a_from_b,
                             const AlignmentConfig& config) {
  return Judge(a, b, config.place)(a_from_b);
}

std::vector<MapAlignment> alignments(const MapDocument& a, const MapDocument& b,
                                     const AlignmentConfig& config) {
  const auto proposals = propose_poses(layout_of(a), layout_of(b), config.layout);
  const SurfacePoints surface_a = thinned_surface(a.map, config.spacing_m),
                      surface_b = thinned_surface(b.map, config.spacing_m);
  const SurfaceFit fit(surface_a, surface_b);
  const Judge judge(a, b, config.place);
  std::vector<MapAlignment> answers;
  for (const LayoutProposal& proposal : proposals) {
    answers.push_back(judge(fit.refine(proposal.a_from_b, kFarReaches_m, kFarRounds)));
    answers.back().objects = proposal.objects;
  }
  std::stable_sort(answers.begin(), answers.end(),
                   [](const auto& x, const auto& y) { return x.score() > y.score(); });
  return answers;
}

AlignmentSearch search_alignment(const MapDocument& a, const MapDocument& b,
                                 const AlignmentConfig& config) {
  const std::vector<MapAlignment> answers = alignments(a, b, config);
  if (answers.empty()) return {{}, "too few objects are alike"};
  AlignmentSearch search{answers.front(), {}};
  for (const MapAlignment& other : answers)
    if (!same_answer(other.a_from_b, search.best.a_from_b))
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
