// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/camera/gaze_planner.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "ovimap/base/parallel.h"

namespace ovimap {
namespace {

constexpr int kSides = 24;           // directions from which a thing counts as seen anew
constexpr double kNewSide = 0.8;     // worth of each further side, against the one before
constexpr double kSeenAgain = 0.03;  // worth of a view from a side already seen
constexpr double kShellWeight =
    0.1;  // of a patch of wall or floor, against 1 for a piece of furniture
constexpr float kShellGrid_m = 0.7f;
constexpr double kLeastDistance_m = 0.45, kBestDistance_m = 1.8;
constexpr double kWellInView = 0.85;  // share of the field of view in which things count as seen
constexpr int kYaws = 60;
constexpr std::array<double, 8> kPitches_rad = {-0.9, -0.7, -0.5, -0.3, -0.1, 0.1, 0.3, 0.5};
constexpr int kLevel = 3;             // of the pitches, where guesses start
constexpr double kTurnCost = 0.25;    // of a turn by the full reach
constexpr double kBeyondReach = 1e3;  // cost of a turn by more than that
constexpr int kSweeps = 12;

double wrapped(double angle) {
  return std::remainder(angle, 2 * std::numbers::pi);
}

/// Whether the angle, wrapped, is less than `reach` from zero. The remainder is exact and slow, so
/// it is asked only where the last bits count.
bool within(double angle, double reach) {
  constexpr double kTurn = 2 * std::numbers::pi, kDoubt = 1e-9;
  const auto turns =
      static_cast<double>(static_cast<long>(angle / kTurn + (angle < 0 ? -0.5 : 0.5)));
  const double beyond = std::abs(angle - kTurn * turns) - reach;
  return std::abs(beyond) > kDoubt ? beyond < 0 : std::abs(wrapped(angle)) < reach;
}

/// Something worth looking at.
struct Sight {
  Eigen::Vector3d place;
  std::uint16_t id;
  double weight;
};

std::vector<Sight> sights_of(const SynthRoom& room) {
  std::vector<Sight> sights;
  for (const RoomObject& object : room.objects) {
    if (object.box.isEmpty()) continue;  // away
    if (object.footprint) {
      const Eigen::Vector3f center = object.box.center();
      sights.push_back({center.cast<double>(), object.id, 1});
      continue;
    }
    const Eigen::Vector3f size = object.box.sizes();
    const Eigen::Array3i steps = (size.array() / kShellGrid_m).cast<int>().max(1);
    for (int x = 0; x < steps.x(); ++x)
      for (int y = 0; y < steps.y(); ++y)
        for (int z = 0; z < steps.z(); ++z) {
          const Eigen::Array3f part =
              (Eigen::Array3i(x, y, z).cast<float>() + 0.5f) / steps.cast<float>();
          const Eigen::Vector3f place = object.box.min() + (part * size.array()).matrix();
          sights.push_back({place.cast<double>(), object.id, kShellWeight});
        }
  }
  return sights;
}

/// A sight as it lies from one place of the walk.
struct Glimpse {
  std::size_t sight;
  double yaw, pitch;  ///< its direction
  double near;        ///< 1 for near things, less for far ones
  int side;
};

/// The middle of a thing may be empty, as a chair's: then the ray must at least get there.
bool visible(const Sight& sight, const RayScene& scene, const Eigen::Vector3d& eye,
             const Eigen::Vector3d& direction) {
  const auto hit = scene.trace(eye, direction);
  return !hit || hit->distance > 1 || scene.objects()[hit->object].id == sight.id;
}

std::vector<Glimpse> glimpses_from(const Eigen::Vector3d& eye, const std::vector<Sight>& sights,
                                   const RayScene& scene) {
  std::vector<Glimpse> glimpses;
  for (std::size_t i = 0; i < sights.size(); ++i) {
    const Eigen::Vector3d direction = sights[i].place - eye;
    const double distance = direction.norm();
    if (distance < kLeastDistance_m || distance > kFarthestSeen_m ||
        !visible(sights[i], scene, eye, direction))
      continue;
    const double yaw = std::atan2(direction.y(), direction.x());
    const int side =
        static_cast<int>((yaw + std::numbers::pi) / (2 * std::numbers::pi) * kSides) % kSides;
    glimpses.push_back({i, yaw, std::atan2(direction.z(), std::hypot(direction.x(), direction.y())),
                        std::min(1.0, kBestDistance_m / distance), side});
  }
  return glimpses;
}

struct Choice {
  int yaw = 0, pitch = kLevel;  ///< numbers of the grid of gazes
};

class Plan {
 public:
  Plan(const SynthRoom& room, const RayScene& scene, const PinholeCamera& camera,
       std::span<const Eigen::Vector3d> eyes, double reach)
      : sights_(sights_of(room)), glimpses_(eyes.size()), reach_(reach) {
    half_width_ = kWellInView * std::atan(0.5 * camera.width / camera.fx);
    half_height_ = kWellInView * std::atan(0.5 * camera.height / camera.fy);
    parallel_for(eyes.size(), 1,
                 [&](std::size_t i) { glimpses_[i] = glimpses_from(eyes[i], sights_, scene); });
  }

  /// Improves the guess; returns its worth.
  double improve(std::vector<Choice>& choices) {
    times_.assign(sights_.size(), {});
    for (std::size_t i = 0; i < choices.size(); ++i) count(i, choices[i], 1);
    for (int sweep = 0; sweep < kSweeps; ++sweep)
      for (std::size_t i = 0; i < choices.size(); ++i) choices[i] = best_at(i, choices);
    double worth = 0;
    for (std::size_t i = 0; i < sights_.size(); ++i)
      worth += sights_[i].weight * (1 - std::pow(kNewSide, sides_seen(i)));
    return worth;
  }

  static double yaw_of(const Choice& choice) { return 2 * std::numbers::pi * choice.yaw / kYaws; }
  static double pitch_of(const Choice& choice) {
    return kPitches_rad[static_cast<std::size_t>(choice.pitch)];
  }

 private:
  Choice best_at(std::size_t place, const std::vector<Choice>& choices) {
    const Choice now = choices[place];
    count(place, now, -1);
    Choice best = now;
    double best_worth = worth_of(place, now, choices);
    for (int yaw = 0; yaw < kYaws; ++yaw)
      for (int pitch = 0; pitch < static_cast<int>(kPitches_rad.size()); ++pitch) {
        const double worth = worth_of(place, {yaw, pitch}, choices);
        if (worth > best_worth) best = {yaw, pitch}, best_worth = worth;
      }
    count(place, best, 1);
    return best;
  }

  /// Far below zero, the more so the farther, when the turn from or to a neighbour is beyond reach.
  double worth_of(std::size_t place, const Choice& choice,
                  const std::vector<Choice>& choices) const {
    double worth = 0, beyond = 0;
    for (const std::size_t next : {place - 1, place + 1}) {
      if (next >= choices.size()) continue;
      const double turn = std::max(std::abs(wrapped(yaw_of(choice) - yaw_of(choices[next]))),
                                   std::abs(pitch_of(choice) - pitch_of(choices[next]))) /
                          reach_;
      worth -= kTurnCost * turn * turn;
      if (turn > 1) beyond += kBeyondReach * turn;
    }
    if (beyond > 0) return -beyond;
    for (const Glimpse& glimpse : glimpses_[place]) {
      if (!in_view(glimpse, choice)) continue;
      const bool is_new = times_[glimpse.sight][static_cast<std::size_t>(glimpse.side)] == 0;
      const double gain =
          is_new ? (1 - kNewSide) * std::pow(kNewSide, sides_seen(glimpse.sight)) : 0;
      worth += sights_[glimpse.sight].weight * glimpse.near * (gain * kSides + kSeenAgain);
    }
    return worth;
  }

  void count(std::size_t place, const Choice& choice, int change) {
    for (const Glimpse& glimpse : glimpses_[place])
      if (in_view(glimpse, choice))
        times_[glimpse.sight][static_cast<std::size_t>(glimpse.side)] += change;
  }

  long sides_seen(std::size_t sight) const {
    return std::count_if(times_[sight].begin(), times_[sight].end(), [](int n) { return n > 0; });
  }

  bool in_view(const Glimpse& glimpse, const Choice& choice) const {
    return std::abs(glimpse.pitch - pitch_of(choice)) < half_height_ &&
           within(glimpse.yaw - yaw_of(choice), half_width_);
  }

  std::vector<Sight> sights_;
  std::vector<std::vector<Glimpse>> glimpses_;
  double reach_, half_width_, half_height_;
  std::vector<std::array<int, kSides>> times_;  ///< how often each sight is seen from each side
};

/// A first guess: looking at the middle of the room, turned by `offset_rad`, as far as turns allow.
std::vector<Choice> guess(const SynthRoom& room, std::span<const Eigen::Vector3d> eyes,
                          double offset_rad, double reach_rad) {
  std::vector<Choice> choices;
  const Eigen::Vector2d middle = room.size_m.head<2>().cast<double>() / 2;
  const int reach = std::max(1, static_cast<int>(reach_rad / (2 * std::numbers::pi) * kYaws));
  for (const Eigen::Vector3d& eye : eyes) {
    const Eigen::Vector2d direction = middle - eye.head<2>();
    const double wanted = std::atan2(direction.y(), direction.x()) + offset_rad;
    Choice choice;
    choice.yaw = static_cast<int>(std::lround(wanted / (2 * std::numbers::pi) * kYaws));
    if (!choices.empty()) {
      const double turn = wrapped(wanted - Plan::yaw_of(choices.back()));
      const int steps = static_cast<int>(std::lround(turn / (2 * std::numbers::pi) * kYaws));
      choice.yaw = choices.back().yaw + std::clamp(steps, -reach, reach);
    }
    choices.push_back(choice);
  }
  return choices;
}

}  // namespace

std::vector<Gaze> plan_gazes(const SynthRoom& room, const RayScene& scene,
                             const PinholeCamera& camera, std::span<const Eigen::Vector3d> eyes_m,
                             double reach_rad) {
  constexpr std::array kFirstLooks_rad = {0.0, 0.5 * std::numbers::pi, -0.5 * std::numbers::pi,
                                          std::numbers::pi};  // from the middle of the room
  const Plan plan(room, scene, camera, eyes_m, reach_rad);
  std::array<std::vector<Choice>, kFirstLooks_rad.size()> tries;
  std::array<double, kFirstLooks_rad.size()> worths{};
  parallel_for(tries.size(), 1, [&](std::size_t i) {
    tries[i] = guess(room, eyes_m, kFirstLooks_rad[i], reach_rad);
    worths[i] = Plan(plan).improve(tries[i]);
  });
  const auto& best = tries[static_cast<std::size_t>(std::max_element(worths.begin(), worths.end()) -
                                                    worths.begin())];
  std::vector<Gaze> gazes;
  for (const Choice& choice : best) {
    double yaw = Plan::yaw_of(choice);
    if (!gazes.empty()) yaw = gazes.back().yaw_rad + wrapped(yaw - gazes.back().yaw_rad);
    gazes.push_back({yaw, Plan::pitch_of(choice)});
  }
  return gazes;
}

}  // namespace ovimap
