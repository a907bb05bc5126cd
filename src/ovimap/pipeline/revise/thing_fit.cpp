// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/revise/thing_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "ovimap/eval/geometry/nearest.h"

namespace ovimap {

namespace {

constexpr int kTurns = 36, kRounds = 6;
constexpr float kFirstReach = 0.5f;  // of the larger reach: points so near pull at each other first

using Color = std::array<std::uint8_t, 3>;

bool is_known(const Color& color) { return color[0] + color[1] + color[2] > 0; }

bool alike(const Color& a, const Color& b, float most) {
  if (!is_known(a) || !is_known(b)) return true;
  int sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += std::abs(int{a[i]} - int{b[i]});
  return static_cast<float>(sum) <= most * static_cast<float>(a.size());
}

Eigen::AlignedBox3f box_of(const std::vector<Eigen::Vector3f>& points, const Eigen::Matrix3f& turn) {
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& point : points) box.extend(turn * point);
  return box;
}

/// What lies on what, one way.
struct Told {
  int agreed = 0, apart = 0;
};

class ThingFitter {
 public:
  ThingFitter(const ThingLook& gone, const ThingLook& found, float voxel_m,
              const ThingFitConfig& config)
      : gone_(gone),
        found_(found),
        config_(config),
        in_gone_(gone.points),
        in_found_(found.points),
        reach_m_(std::max(gone.reach_m, found.reach_m)),
        near_m_(std::max(config.near_voxels * voxel_m, config.near_share * reach_m_)) {}

  /// found_from_gone, of their looks' frames.
  Eigen::Isometry3f best() const {
    Eigen::Isometry3f best = Eigen::Isometry3f::Identity();
    float most = -1;
    for (int i = 0; i < kTurns; ++i) {
      const auto angle = static_cast<float>(2 * std::numbers::pi * i / kTurns);
      const Eigen::Matrix3f turn =
          Eigen::AngleAxisf(angle, Eigen::Vector3f::UnitZ()).toRotationMatrix();
      for (const Eigen::Vector3f& shift : first_shifts(turn)) {
        Eigen::Isometry3f pose = Eigen::Isometry3f::Identity();
        pose.linear() = turn;
        pose.translation() = settled(turn, shift);
        if (const float score = score_of(pose); score > most) most = score, best = pose;
      }
    }
    return best;
  }

  template <class SeenThrough>
  Told tell(const ThingLook& from, const NearestPoints& to, const ThingLook& other,
            const Eigen::Isometry3f& pose, const SeenThrough& seen_through) const {
    Told told;
    for (std::size_t i = 0; i < from.points.size(); ++i) {
      const Eigen::Vector3f point = pose * from.points[i];
      const auto near = to.find(point, near_m_);
      if (near)
        ++(alike(from.colors[i], other.colors[near->index], config_.same_color)
               ? told.agreed
               : told.apart);
      else
        told.apart += seen_through(other.world_from_look * point);
    }
    return told;
  }

  ThingFit fit(const ObservedSpace& before, const ObservedSpace& after) const {
    const Eigen::Isometry3f found_from_gone = best();
    const auto through = [this](const ObservedSpace& space) {
      return [this, &space](const Eigen::Vector3f& point) {
        return space.seen_through(point, config_.views) >= config_.views;
      };
    };
    const Told a = tell(gone_, in_found_, found_, found_from_gone, through(after)),
               b = tell(found_, in_gone_, gone_, found_from_gone.inverse(), through(before));
    const auto share = [](int part, int all) {
      return static_cast<float>(part) / static_cast<float>(std::max(all, 1));
    };
    return {std::min(share(a.agreed, static_cast<int>(gone_.points.size())),
                     share(b.agreed, static_cast<int>(found_.points.size()))),
            std::max(share(a.apart, a.apart + a.agreed), share(b.apart, b.apart + b.agreed))};
  }

 private:
  /// Of a thing seen from one side the mean lies nearer to that side; its box often does not.
  std::array<Eigen::Vector3f, 2> first_shifts(const Eigen::Matrix3f& turn) const {
    const Eigen::AlignedBox3f gone = box_of(gone_.points, turn),
                              found = box_of(found_.points, Eigen::Matrix3f::Identity());
    Eigen::Vector3f middles = found.center() - gone.center();
    middles.z() = found.min().z() - gone.min().z();  // both stand on something
    return {Eigen::Vector3f::Zero(), middles};
  }

  /// By the points that lie nearest to each other, both ways, from wide to narrow.
  Eigen::Vector3f settled(const Eigen::Matrix3f& turn, Eigen::Vector3f shift) const {
    float reach_m = kFirstReach * reach_m_;
    for (int round = 0; round < kRounds; ++round, reach_m = std::max(0.6f * reach_m, near_m_)) {
      Eigen::Vector3f pull = Eigen::Vector3f::Zero();
      int count = 0;
      for (const Eigen::Vector3f& point : gone_.points) {
        const Eigen::Vector3f at = turn * point + shift;
        if (const auto near = in_found_.find(at, reach_m))
          pull += found_.points[near->index] - at, ++count;
      }
      for (const Eigen::Vector3f& point : found_.points) {
        const Eigen::Vector3f at = turn.transpose() * (point - shift);
        if (const auto near = in_gone_.find(at, reach_m))
          pull += point - (turn * gone_.points[near->index] + shift), ++count;
      }
      if (count == 0) break;
      shift += pull / static_cast<float>(count);
    }
    return shift;
  }

  /// Share of the points, both ways, that lie on each other and look alike; near ones count more.
  float score_of(const Eigen::Isometry3f& pose) const {
    const auto sum = [this](const ThingLook& from, const NearestPoints& to, const ThingLook& other,
                            const Eigen::Isometry3f& other_from_from) {
      float total = 0;
      for (std::size_t i = 0; i < from.points.size(); ++i)
        if (const auto near = to.find(other_from_from * from.points[i], near_m_);
            near && alike(from.colors[i], other.colors[near->index], config_.same_color))
          total += 1.f - 0.5f * near->distance_m / near_m_;
      return total / static_cast<float>(std::max<std::size_t>(from.points.size(), 1));
    };
    return sum(gone_, in_found_, found_, pose) + sum(found_, in_gone_, gone_, pose.inverse());
  }

  const ThingLook &gone_, &found_;
  const ThingFitConfig& config_;
  NearestPoints in_gone_, in_found_;
  float reach_m_, near_m_;
};

}  // namespace

ThingFit fit_things(const ThingLook& gone, const ObservedSpace& before, const ThingLook& found,
                    const ObservedSpace& after, float voxel_m, const ThingFitConfig& config) {
  if (gone.points.empty() || found.points.empty()) return {};
  return ThingFitter(gone, found, voxel_m, config).fit(before, after);
}

}  // namespace ovimap
