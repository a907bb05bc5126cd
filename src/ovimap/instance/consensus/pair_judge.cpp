// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/instance/consensus/pair_judge.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>

#include "ovimap/instance/consensus/pair_judge_weights.h"

namespace ovimap {

namespace {

constexpr double kThinnestSide = 0.02;  // metres; boxes of flat things have a volume all the same

double volume(const Eigen::AlignedBox3f& box) {
  return box.sizes().cast<double>().cwiseMax(kThinnestSide).prod();
}

double mean_over(double sum, std::int64_t count) {
  return count > 0 ? sum / static_cast<double>(count) : 0;
}

/// max(0, inputs * weights + bias), input by input: outputs beside each other fill wide registers.
template <std::size_t kOutputs, std::size_t kInputs>
std::array<float, kOutputs> layer(const float (&weights)[kInputs][kOutputs],
                                  const float (&bias)[kOutputs],
                                  const std::array<float, kInputs>& inputs) {
  std::array<float, kOutputs> outputs;
  std::copy_n(bias, kOutputs, outputs.begin());
  for (std::size_t k = 0; k < kInputs; ++k)
    for (std::size_t i = 0; i < kOutputs; ++i) outputs[i] += weights[k][i] * inputs[k];
  for (float& output : outputs) output = std::max(0.f, output);
  return outputs;
}

/// Intersection over union of an entity and a cluster in a frame.
double overlap(double shared, double cluster, double entity) {
  return shared / (cluster + entity - shared);
}

double vertices_of(std::span<const EntityShare> shares) {
  double sum = 0;
  for (const EntityShare& share : shares) sum += static_cast<double>(share.vertices);
  return sum;
}

/// Two clusters in one frame.
void meet(std::span<const EntityShare> a, std::span<const EntityShare> b, Meetings& sum) {
  const double of_a = vertices_of(a), of_b = vertices_of(b);
  double both = 0, fit_a = 0, fit_b = 0, fit_both = 0;
  for (auto i = a.begin(), j = b.begin(); i != a.end() || j != b.end();) {
    const bool in_a = i != a.end() && (j == b.end() || i->sighting <= j->sighting);
    const bool in_b = j != b.end() && (i == a.end() || j->sighting <= i->sighting);
    const auto entity = static_cast<double>((in_a ? i : j)->entity_vertices);
    const double shared_a = in_a ? static_cast<double>((i++)->vertices) : 0;
    const double shared_b = in_b ? static_cast<double>((j++)->vertices) : 0;
    both += shared_a * shared_b;
    fit_a = std::max(fit_a, overlap(shared_a, of_a, entity));
    fit_b = std::max(fit_b, overlap(shared_b, of_b, entity));
    fit_both = std::max(fit_both, overlap(shared_a + shared_b, of_a + of_b, entity));
  }
  sum.joined += both / (of_a * of_b);
  sum.apart += 1 - both / (of_a * of_b);
  sum.fit_a += fit_a;
  sum.fit_b += fit_b;
  sum.fit_both += fit_both;
}

}  // namespace

Meetings meetings_of(const PointCluster& a, const PointCluster& b) {
  Meetings sum;
  for (auto i = a.shares.begin(), j = b.shares.begin();
       i != a.shares.end() && j != b.shares.end();) {
    const std::uint32_t frame = std::max(i->sighting.frame, j->sighting.frame);
    while (i != a.shares.end() && i->sighting.frame < frame) ++i;
    while (j != b.shares.end() && j->sighting.frame < frame) ++j;
    const auto end_of = [frame](auto share, auto end) {
      while (share != end && share->sighting.frame == frame) ++share;
      return share;
    };
    const auto i_end = end_of(i, a.shares.end()), j_end = end_of(j, b.shares.end());
    if (i != i_end && j != j_end) meet({i, i_end}, {j, j_end}, sum);
    i = i_end;
    j = j_end;
  }
  return sum;
}

PointCluster united(const PointCluster& a, const PointCluster& b) {
  PointCluster both{{}, a.shape, a.rated || b.rated};
  both.shape += b.shape;
  both.shares.reserve(a.shares.size() + b.shares.size());
  std::merge(a.shares.begin(), a.shares.end(), b.shares.begin(), b.shares.end(),
             std::back_inserter(both.shares),
             [](const EntityShare& x, const EntityShare& y) { return x.sighting < y.sighting; });
  std::size_t kept = 0;
  for (std::size_t i = 1; i < both.shares.size(); ++i) {
    if (both.shares[i].sighting == both.shares[kept].sighting)
      both.shares[kept].vertices += both.shares[i].vertices;
    else
      both.shares[++kept] = both.shares[i];
  }
  both.shares.resize(std::min(both.shares.size(), kept + 1));
  return both;
}

PairFeatures pair_features(const PointCluster& a, const PointCluster& b, const Meetings& met,
                           const SuperPointBorder& border, float agreement) {
  const bool swapped = a.shape.vertices > b.shape.vertices;
  const SuperPointShape& small = swapped ? b.shape : a.shape;
  const SuperPointShape& large = swapped ? a.shape : b.shape;
  const double small_size = static_cast<double>(std::max<std::int64_t>(1, small.vertices));
  const double large_size = static_cast<double>(std::max<std::int64_t>(1, large.vertices));
  const Eigen::Vector3d color =
      (small.color_sum / small_size - large.color_sum / large_size).cwiseAbs();
  const Eigen::Vector3d small_normal = small.normal_sum / small_size;
  const Eigen::Vector3d large_normal = large.normal_sum / large_size;
  const Eigen::Vector3d between = large.position_sum / large_size - small.position_sum / small_size;
  const double all = volume(small.box.merged(large.box));
  const double small_volume = volume(small.box), large_volume = volume(large.box);

  PairFeatures features{};
  const auto set = [&](PairFeature feature, double value) {
    features[static_cast<std::size_t>(feature)] = static_cast<float>(value);
  };
  set(PairFeature::kJoined, std::log1p(met.joined));
  set(PairFeature::kApart, std::log1p(met.apart));
  set(PairFeature::kJoinedShare, (met.joined + 0.5) / (met.joined + met.apart + 1));
  set(PairFeature::kSmallSize, std::log(small_size));
  set(PairFeature::kLargeSize, std::log(large_size));
  set(PairFeature::kContact, std::log1p(static_cast<double>(border.edges) / std::sqrt(small_size)));
  set(PairFeature::kTouching, border.edges > 0);
  set(PairFeature::kFold, mean_over(border.fold, border.edges));
  set(PairFeature::kStep, mean_over(border.color_step, border.edges) / 64);
  set(PairFeature::kColor, color.sum() / 64);
  set(PairFeature::kTone, std::abs(color[0] - color[2]) / 64);
  set(PairFeature::kAlign, small_normal.dot(large_normal));
  set(PairFeature::kSmallFlat, small_normal.norm());
  set(PairFeature::kLargeFlat, large_normal.norm());
  set(PairFeature::kSmallOffset, std::abs(small_normal.normalized().dot(between)));
  set(PairFeature::kLargeOffset, std::abs(large_normal.normalized().dot(between)));
  const bool both_known = small.vertices > 0 && large.vertices > 0;
  set(PairFeature::kGap, both_known ? small.box.exteriorDistance(large.box) : 0);
  set(PairFeature::kLargerBox, std::log(all / std::max(small_volume, large_volume)));
  set(PairFeature::kBothBoxes, std::log(all / (small_volume + large_volume)));
  set(PairFeature::kLargeVolume, std::log(large_volume));
  const double frames = std::max(1., met.joined + met.apart);
  set(PairFeature::kFitBoth, met.fit_both / frames);
  set(PairFeature::kFitSmall, (swapped ? met.fit_b : met.fit_a) / frames);
  set(PairFeature::kFitLarge, (swapped ? met.fit_a : met.fit_b) / frames);
  set(PairFeature::kAgreement, agreement);
  return features;
}

float log_odds_of_one(const PairFeatures& features) {
  using namespace pair_judge_weights;
  static_assert(kInputs == std::tuple_size_v<PairFeatures>);
  float sum = 0;
  for (std::size_t net = 0; net < kNetworks; ++net) {
    const auto first = layer(kFirst[net], kFirstBias[net], features);
    const auto second = layer(kSecond[net], kSecondBias[net], first);
    sum += kLastBias[net];
    for (std::size_t i = 0; i < kHidden; ++i) sum += kLast[net][i] * second[i];
  }
  return sum / static_cast<float>(kNetworks);
}

}  // namespace ovimap
