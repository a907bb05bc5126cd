// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/revise/thing_look.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ovimap/eval/geometry/nearest.h"
#include "ovimap/geometry/pose.h"
#include "ovimap/map/rays/surface_lookup.h"

namespace ovimap {

namespace {

constexpr int kTurns = 36;
constexpr int kRefined = 6;  // of the turns, those that fit best, ...
constexpr int kSteps = 8;    // ... are drawn together: a mean of what was seen of one side is off
constexpr double kNearShare = 0.8;  // of the points; the others were hidden from the other visit
constexpr std::size_t kMostPoints = 400;

/// Adds a colour of 16 bits a channel to the cells around it, by how near it is to their middles:
/// one that lies between two cells, and is a little lighter elsewhere, is still the same.
void add_color(const FixedColor& color, std::array<float, 64>& shares) {
  std::array<std::size_t, 3> lower;
  std::array<float, 3> upper_share;
  for (std::size_t channel = 0; channel < color.size(); ++channel) {
    const float place = std::clamp(color[channel] / 16384.f - 0.5f, 0.f, 3.f);
    lower[channel] = std::min<std::size_t>(static_cast<std::size_t>(place), 2);
    upper_share[channel] = place - static_cast<float>(lower[channel]);
  }
  for (std::size_t corner = 0; corner < 8; ++corner) {
    std::size_t cell = 0;
    float share = 1;
    for (std::size_t channel = 0; channel < color.size(); ++channel) {
      const bool upper = (corner >> channel & 1) != 0;
      cell = 4 * cell + lower[channel] + (upper ? 1 : 0);
      share *= upper ? upper_share[channel] : 1 - upper_share[channel];
    }
    shares[cell] += share;
  }
}

/// The colours of a map's voxels at points.
std::array<float, 64> colors_at(const VoxelMap& map, const std::vector<Eigen::Vector3f>& points) {
  std::array<float, 64> shares{};
  VoxelFinder finder(map);
  float known = 0;
  for (const Eigen::Vector3f& point : points) {
    if (!finder.seek(point)) continue;
    const auto v = static_cast<std::size_t>(finder.voxel());
    const PackedColor color = finder.block().color[v];
    if (color == 0) continue;
    add_color(unpack_color(color), shares);
    known += 1;
  }
  for (float& share : shares) share /= std::max(known, 1.f);
  return shares;
}

/// Two things of which one is laid over the other.
class ShapeFit {
 public:
  ShapeFit(const ThingLook& a, const ThingLook& b)
      : a_(a), b_(b), in_a_(a.points), in_b_(b.points), reach_m_(std::max(a.reach_m, b.reach_m)) {}

  /// The larger of the mean distances of either's nearer points to the other.
  double distance_m(const Eigen::Isometry3f& b_from_a) const {
    return std::max(mean_of_near(pulls(a_, in_b_, b_, b_from_a)),
                    mean_of_near(pulls(b_, in_a_, a_, b_from_a.inverse())));
  }

  /// Moved by what the nearer points of both are off in the mean.
  Eigen::Isometry3f drawn_together(const Eigen::Isometry3f& b_from_a) const {
    std::vector<Eigen::Vector3f> off = pulls(a_, in_b_, b_, b_from_a);
    for (const Eigen::Vector3f& back : pulls(b_, in_a_, a_, b_from_a.inverse()))
      off.push_back(-(b_from_a.linear() * back));
    keep_near(off);
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    for (const Eigen::Vector3f& pull : off) sum += pull;
    return Eigen::Translation3f(sum / static_cast<float>(off.size())) * b_from_a;
  }

 private:
  /// From each point of `from` to the nearest of `to`; the reach away where none is within it.
  std::vector<Eigen::Vector3f> pulls(const ThingLook& from, const NearestPoints& in_to,
                                     const ThingLook& to,
                                     const Eigen::Isometry3f& to_from_from) const {
    std::vector<Eigen::Vector3f> pulls;
    for (const Eigen::Vector3f& point : from.points) {
      const Eigen::Vector3f there = to_from_from * point;
      const auto near = in_to.find(there, reach_m_);
      pulls.push_back(near ? Eigen::Vector3f(to.points[near->index] - there)
                           : Eigen::Vector3f(0.f, 0.f, reach_m_));
    }
    return pulls;
  }

  static void keep_near(std::vector<Eigen::Vector3f>& pulls) {
    const auto kept =
        static_cast<std::ptrdiff_t>(std::ceil(kNearShare * static_cast<double>(pulls.size())));
    std::nth_element(
        pulls.begin(), pulls.begin() + kept - 1, pulls.end(),
        [](const auto& x, const auto& y) { return x.squaredNorm() < y.squaredNorm(); });
    pulls.resize(static_cast<std::size_t>(kept));
  }

  static double mean_of_near(std::vector<Eigen::Vector3f> pulls) {
    keep_near(pulls);
    double sum = 0;
    for (const Eigen::Vector3f& pull : pulls) sum += static_cast<double>(pull.norm());
    return sum / static_cast<double>(pulls.size());
  }

  const ThingLook &a_, &b_;
  NearestPoints in_a_, in_b_;
  float reach_m_;
};

}  // namespace

ThingLook thing_look(const MapDocument& map, InstanceId id, const Eigen::Vector3f& up) {
  ThingLook look;
  const auto surface = map.surfaces.find(id);
  if (surface == map.surfaces.end() || surface->second.empty()) return look;
  look.colors = colors_at(map.map, surface->second);
  map.map.trim();
  const std::size_t step = (surface->second.size() + kMostPoints - 1) / kMostPoints;
  const Eigen::Matrix3f upright = shortest_turn(up, Eigen::Vector3f::UnitZ()).toRotationMatrix();
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();
  for (std::size_t i = 0; i < surface->second.size(); i += step) {
    look.points.push_back(upright * surface->second[i]);
    mean += look.points.back();
  }
  mean /= static_cast<float>(look.points.size());
  float squares = 0;
  for (Eigen::Vector3f& point : look.points) squares += (point -= mean).squaredNorm();
  look.reach_m = std::sqrt(squares / static_cast<float>(look.points.size()));
  return look;
}

float shape_distance(const ThingLook& a, const ThingLook& b) {
  const float reach_m = std::max(a.reach_m, b.reach_m);
  if (a.points.empty() || b.points.empty() || reach_m <= 0.f) return 1.f;
  const ShapeFit fit(a, b);
  std::vector<std::pair<double, Eigen::Isometry3f>> turned;
  for (int i = 0; i < kTurns; ++i) {
    const auto angle = static_cast<float>(2 * std::numbers::pi * i / kTurns);
    const Eigen::Isometry3f turn(Eigen::AngleAxisf(angle, Eigen::Vector3f::UnitZ()));
    turned.emplace_back(fit.distance_m(turn), turn);
  }
  std::partial_sort(turned.begin(), turned.begin() + kRefined, turned.end(),
                    [](const auto& x, const auto& y) { return x.first < y.first; });
  double best = std::min(static_cast<double>(reach_m), turned.front().first);
  for (int i = 0; i < kRefined; ++i)
    for (int step = 0; step < kSteps; ++step) {
      Eigen::Isometry3f& laid = turned[static_cast<std::size_t>(i)].second;
      laid = fit.drawn_together(laid);
      best = std::min(best, fit.distance_m(laid));
    }
  return static_cast<float>(best) / reach_m;
}

float common_colors(const ThingLook& a, const ThingLook& b) {
  float common = 0, in_a = 0, in_b = 0;
  for (std::size_t i = 0; i < a.colors.size(); ++i) {
    common += std::min(a.colors[i], b.colors[i]);
    in_a += a.colors[i];
    in_b += b.colors[i];
  }
  return in_a == 0.f || in_b == 0.f ? 1.f : common;
}

}  // namespace ovimap
