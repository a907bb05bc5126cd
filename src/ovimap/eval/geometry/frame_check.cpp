// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/eval/geometry/frame_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "ovimap/base/config.h"
#include "ovimap/eval/geometry/nearest.h"

namespace ovimap {

namespace {

/// truth = scale * turn * map + shift_m
struct Reading {
  float scale = 1;
  Eigen::Matrix3f turn = Eigen::Matrix3f::Identity();
  Eigen::Vector3f shift_m = Eigen::Vector3f::Zero();
  bool shifted = false;
};

std::vector<Eigen::Vector3f> sample(std::span<const Eigen::Vector3f> points, int count) {
  const std::size_t step =
      std::max<std::size_t>(1, points.size() / static_cast<std::size_t>(count));
  std::vector<Eigen::Vector3f> samples;
  for (std::size_t i = 0; i < points.size(); i += step) samples.push_back(points[i]);
  return samples;
}

double share_near(const NearestPoints& points, std::span<const Eigen::Vector3f> samples,
                  float radius_m) {
  const auto found = points.find_all(samples, radius_m);
  const auto near =
      std::count_if(found.begin(), found.end(), [](const auto& n) { return n.has_value(); });
  return static_cast<double>(near) / static_cast<double>(samples.size());
}

/// Where points are, strays aside: per axis between the outer percentiles.
Eigen::AlignedBox3f trimmed_box(std::span<const Eigen::Vector3f> samples) {
  constexpr double kOuterShare = 0.02;
  Eigen::AlignedBox3f box(Eigen::Vector3f::Zero(), Eigen::Vector3f::Zero());
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<float> values;
    for (const Eigen::Vector3f& point : samples) values.push_back(point[axis]);
    std::sort(values.begin(), values.end());
    const auto outer =
        static_cast<std::size_t>(kOuterShare * static_cast<double>(values.size() - 1));
    box.min()[axis] = values[outer], box.max()[axis] = values[values.size() - 1 - outer];
  }
  return box;
}

/// The 24 rotations that take axes to axes; the first is none.
std::vector<Eigen::Matrix3f> axis_turns() {
  std::vector<Eigen::Matrix3f> turns;
  std::array<int, 3> axes = {0, 1, 2};
  do {
    for (int signs = 0; signs < 8; ++signs) {
      Eigen::Matrix3f turn = Eigen::Matrix3f::Zero();
      for (int row = 0; row < 3; ++row)
        turn(row, axes[static_cast<std::size_t>(row)]) = (signs >> row & 1) != 0 ? -1.f : 1.f;
      if (turn.determinant() > 0) turns.push_back(turn);
    }
  } while (std::next_permutation(axes.begin(), axes.end()));
  return turns;
}

/// Whether the sizes allow that scale. Without this, a map shrunk to a point would lie near to
/// anything.
bool plausible(float scale, const Eigen::AlignedBox3f& truth, const Eigen::AlignedBox3f& map) {
  constexpr float kMostOff = 4;
  const float ratio = truth.diagonal().norm() / (scale * map.diagonal().norm());
  return ratio < kMostOff && ratio > 1 / kMostOff;
}

/// From the simplest on.
std::vector<Reading> readings(const Eigen::AlignedBox3f& truth, const Eigen::AlignedBox3f& map) {
  constexpr std::array<float, 7> kScales = {1.f, 1000.f, 0.001f, 100.f, 0.01f, 10.f, 0.1f};
  const std::vector<Eigen::Matrix3f> turns = axis_turns();
  std::vector<Reading> all;
  for (const bool shifted : {false, true})
    for (const Eigen::Matrix3f& turn : turns)
      for (const float scale : kScales) {
        if (!plausible(scale, truth, map)) continue;
        Reading reading{scale, turn, Eigen::Vector3f::Zero(), shifted};
        if (shifted) reading.shift_m = truth.center() - scale * (turn * map.center());
        all.push_back(reading);
      }
  return all;
}

/// The row of a turn as "-y".
std::string axis_name(const Eigen::Matrix3f& turn, int row) {
  int axis = 0;
  turn.row(row).cwiseAbs().maxCoeff(&axis);
  return concat(turn(row, axis) < 0 ? "-" : "", "xyz"[axis]);
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

std::string extent(std::span<const Eigen::Vector3f> points) {
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& point : points) box.extend(point);
  const auto corner = [](const Eigen::Vector3f& at) {
    return concat("(", number(at.x()), ", ", number(at.y()), ", ", number(at.z()), ")");
  };
  return concat(corner(box.min()), " to ", corner(box.max()));
}

std::string describe(const Reading& reading, double share) {
  std::vector<std::string> differences;
  if (reading.scale != 1)
    differences.push_back(
        concat("the truth's numbers are ", number(reading.scale), " times the map's"));
  if (!reading.turn.isIdentity())
    differences.push_back(concat("the truth's x, y, z are the map's ", axis_name(reading.turn, 0),
                                 ", ", axis_name(reading.turn, 1), ", ",
                                 axis_name(reading.turn, 2)));
  if (reading.shifted)
    differences.push_back(concat("the truth's origin lies elsewhere, by (",
                                 number(reading.shift_m.x()), ", ", number(reading.shift_m.y()),
                                 ", ", number(reading.shift_m.z()), ")"));
  std::string text = "it looks as if ";
  for (std::size_t i = 0; i < differences.size(); ++i)
    text += (i > 0 ? " and " : "") + differences[i];
  return concat(text, " (then ", static_cast<int>(std::lround(100 * share)),
                " % of the map lies on the truth); bring both to one frame, in metres");
}

}  // namespace

void list_fields(FrameCheckConfig& config, ConfigFields& fields) {
  fields.add("radius_m", config.radius_m, 0.001f, 1.f,
             "how near the truth must be to a point of the map, in metres");
  fields.add("good_share", config.good_share, 0.f, 1.f,
             "share of the map near the truth that needs no explanation");
  fields.add(
      "least_share", config.least_share, 0.f, 1.f,
      "a map with a smaller share near its truth, and the truth near it, is another scene's");
  fields.add("better_ratio", config.better_ratio, 1.f, 100.f,
             "how many times that share other units or axes must explain to be named");
  fields.add("samples", config.samples, 10, 1000000, "points of either side that are looked at");
}

FrameCheck check_frames(std::span<const Eigen::Vector3f> truth,
                        std::span<const Eigen::Vector3f> predicted,
                        const FrameCheckConfig& config) {
  OVIMAP_ASSERT(!truth.empty() && !predicted.empty());
  const NearestPoints truth_points(truth);
  const std::vector<Eigen::Vector3f> map = sample(predicted, config.samples);
  FrameCheck check{share_near(truth_points, map, config.radius_m), {}};
  if (check.share >= config.good_share) return check;
  const std::vector<Eigen::Vector3f> truth_samples = sample(truth, config.samples);
  const double needed = std::max<double>(config.good_share, config.better_ratio * check.share);
  std::optional<Reading> best;
  double best_share = 0;
  for (const Reading& reading : readings(trimmed_box(truth_samples), trimmed_box(map))) {
    std::vector<Eigen::Vector3f> moved;
    for (const Eigen::Vector3f& point : map)
      moved.emplace_back(reading.scale * (reading.turn * point) + reading.shift_m);
    // The side in metres has the smaller numbers; the radius is meant in metres.
    const double share =
        share_near(truth_points, moved, config.radius_m * std::max(1.f, reading.scale));
    const bool simplest_enough = best && !best->shifted && reading.shifted;
    if (share < needed || share <= best_share || simplest_enough) continue;
    best = reading, best_share = share;
  }
  if (best) {
    check.fault = describe(*best, best_share);
    return check;
  }
  const double truth_share = share_near(NearestPoints(predicted), truth_samples, config.radius_m);
  if (std::max(check.share, truth_share) < config.least_share)
    check.fault = concat("they do not overlap: the map spans ", extent(predicted), ", the truth ",
                         extent(truth), "; are they of the same scene, in the same frame?");
  return check;
}

}  // namespace ovimap
