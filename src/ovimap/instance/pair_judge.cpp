// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/instance/pair_judge.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "ovimap/instance/pair_judge_weights.h"

namespace ovimap {

namespace {

constexpr double kThinnestSide = 0.02;  // metres; boxes of flat things have a volume all the same

double volume(const Eigen::AlignedBox3f& box) {
  return box.sizes().cast<double>().cwiseMax(kThinnestSide).prod();
}

double mean_over(double sum, std::int64_t count) {
  return count > 0 ? sum / static_cast<double>(count) : 0;
}

/// max(0, weights * inputs + bias).
template <std::size_t kOutputs, std::size_t kInputs>
std::array<float, kOutputs> layer(const float (&weights)[kOutputs][kInputs],
                                  const float (&bias)[kOutputs],
                                  const std::array<float, kInputs>& inputs) {
  std::array<float, kOutputs> outputs;
  for (std::size_t i = 0; i < kOutputs; ++i) {
    float sum = bias[i];
    for (std::size_t k = 0; k < kInputs; ++k) sum += weights[i][k] * inputs[k];
    outputs[i] = std::max(0.f, sum);
  }
  return outputs;
}

}  // namespace

Meetings meetings_of(const PointCluster& a, const PointCluster& b) {
  Meetings sum;
  for (auto i = a.shares.begin(), j = b.shares.begin();
       i != a.shares.end() && j != b.shares.end();) {
    const std::uint32_t frame = std::max(i->sighting.frame, j->sighting.frame);
    while (i != a.shares.end() && i->sighting.frame < frame) ++i;
    while (j != b.shares.end() && j->sighting.frame < frame) ++j;
    double in_a = 0, in_b = 0, both = 0;
    for (auto k = j; k != b.shares.end() && k->sighting.frame == frame; ++k)
      in_b += static_cast<double>(k->vertices);
    auto partner = j;
    for (; i != a.shares.end() && i->sighting.frame == frame; ++i) {
      in_a += static_cast<double>(i->vertices);
      while (partner != b.shares.end() && partner->sighting < i->sighting) ++partner;
      if (partner != b.shares.end() && partner->sighting == i->sighting)
        both += static_cast<double>(i->vertices) * static_cast<double>(partner->vertices);
    }
    if (in_a > 0 && in_b > 0) {
      sum.joined += both / (in_a * in_b);
      sum.apart += 1 - both / (in_a * in_b);
    }
  }
  return sum;
}

PointCluster united(const PointCluster& a, const PointCluster& b) {
  PointCluster both{{}, a.shape};
  both.shape += b.shape;
  both.shares.reserve(a.shares.size() + b.shares.size());
  std::merge(a.shares.begin(), a.shares.end(), b.shares.begin(), b.shares.end(),
             std::back_inserter(both.shares), [](const EntityShare& x, const EntityShare& y) {
               return x.sighting < y.sighting;
             });
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

PairFeatures pair_features(const PointCluster& a, const PointCluster& b,
                           const SuperPointBorder& border, float agreement) {
  const bool swapped = a.shape.vertices > b.shape.vertices;
  const SuperPointShape& small = swapped ? b.shape : a.shape;
  const SuperPointShape& large = swapped ? a.shape : b.shape;
  const double small_size = static_cast<double>(std::max<std::int64_t>(1, small.vertices));
  const double large_size = static_cast<double>(std::max<std::int64_t>(1, large.vertices));
  const Meetings met = meetings_of(a, b);
  const Eigen::Vector3d color =
      (small.color_sum / small_size - large.color_sum / large_size).cwiseAbs();
  const Eigen::Vector3d small_normal = small.normal_sum / small_size;
  const Eigen::Vector3d large_normal = large.normal_sum / large_size;
  const Eigen::Vector3d between =
      large.position_sum / large_size - small.position_sum / small_size;
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
  set(PairFeature::kContact,
      std::log1p(static_cast<double>(border.edges) / std::sqrt(small_size)));
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
  set(PairFeature::kAgreement, agreement);
  return features;
}

float log_odds_of_one(const PairFeatures& features) {
  using namespace pair_judge_weights;
  static_assert(kInputs == std::tuple_size_v<PairFeatures>);
  std::array<float, kInputs> inputs;
  for (std::size_t i = 0; i < kInputs; ++i)
    inputs[i] = (features[i] - kMean[i]) * kInverseDeviation[i];
  float sum = 0;
  for (std::size_t net = 0; net < kNetworks; ++net) {
    const auto first = layer(kFirst[net], kFirstBias[net], inputs);
    const auto second = layer(kSecond[net], kSecondBias[net], first);
    sum += kLastBias[net];
    for (std::size_t i = 0; i < kHidden; ++i) sum += kLast[net][i] * second[i];
  }
  return sum / static_cast<float>(kNetworks);
}

}  // namespace ovimap
