// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/camera/walk.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "ovimap/base/config.h"
#include "ovimap/base/error.h"
#include "ovimap/synth/camera/gaze_planner.h"
#include "ovimap/synth/camera/trajectory.h"
#include "ovimap/synth/camera/walk_path.h"

namespace ovimap {
namespace {

constexpr double kRevolution_rad = 2 * std::numbers::pi;
constexpr std::uint64_t kWalkStream = 6001;
constexpr double kPathSpacing_s = 0.25;  // between control points of the way
constexpr double kGazeSpacing_s = 1;     // between decisions where to look
constexpr float kDrift_hz[] = {0.1f, 0.4f}, kTremor_hz[] = {8, 12};
constexpr double kSurveySpacing_s = 1;
constexpr int kCornersPerRoom = 10;
constexpr float kOutward = 0.75f;        // of the way from a room's middle to its walls
constexpr float kStandsThere_m = 0.15f;  // from a point that counts as reached
constexpr float kLeastRound_m = 1.5f;    // of a room's round; less is no walk

constexpr double kWhipPeriod_s = 4, kWhip_s = 1.5;  // of one pan aside and back

/// Yaw beside where one would look. Smooth up to the second derivative, to the left and right in
/// turn: the square of a raised cosine, whose fastest change is 3 sqrt(3) / 8 of its height times
/// the speed of its phase.
double whip_rad(double time_s, double fastest_rad_s) {
  const double count = std::floor(time_s / kWhipPeriod_s), since = time_s - count * kWhipPeriod_s;
  const double phase = kRevolution_rad * std::min(since / kWhip_s, 1.0);
  const double height = fastest_rad_s * kWhip_s / kRevolution_rad * 8 / (3 * std::numbers::sqrt3);
  const double pulse = (1 - std::cos(phase)) / 2;
  return (std::fmod(count, 2) == 0 ? height : -height) * pulse * pulse;
}

/// Where the body may be: furniture is walked round, not stepped over.
WalkMap free_floor(const SynthRoom& room, const WalkConfig& config) {
  TrajectoryConfig body;
  body.lowest_eye_m = body.highest_eye_m = config.eye_m;
  body.body_radius_m = config.body_radius_m;
  body.low_furniture_cost = std::numeric_limits<float>::infinity();
  return {room, body};
}

/// Places all round a room, from the side where one comes from; those that cannot be reached are
/// left out.
void add_corners(const WalkMap& map, const Eigen::AlignedBox2f& floor, const Eigen::Vector2f& from,
                 std::vector<Eigen::Vector2f>& corners) {
  const Eigen::Vector2f middle = floor.center(), half = floor.sizes() / 2;
  const double first = std::atan2(from.y() - middle.y(), from.x() - middle.x());
  for (int i = 0; i < kCornersPerRoom; ++i) {
    const double angle = first + kRevolution_rad * i / kCornersPerRoom;
    const Eigen::Vector2f direction(static_cast<float>(std::cos(angle)),
                                    static_cast<float>(std::sin(angle)));
    const float reach = (half.array() / direction.array().abs().max(1e-6f)).minCoeff();
    const auto place = map.nearest_free(middle + kOutward * reach * direction);
    if (place && floor.contains(*place) && (corners.empty() || *place != corners.back()))
      corners.push_back(*place);
  }
}

}  // namespace

void list_fields(WalkConfig& config, ConfigFields& fields) {
  fields.add("fps", config.fps, 1.f, 1000.f, "frames a second");
  fields.add("seconds", config.seconds, 0.f, 1e5f, "how long; 0: once round");
  fields.add("speed_mps", config.speed_mps, 0.05f, 3.f, "walking speed, metres a second");
  fields.add("max_turn_rad_s", config.max_turn_rad_s, 0.15f, 10.f,
             "fastest turn of the gaze, radians a second");
  fields.add("eye_m", config.eye_m, 0.3f, 2.2f, "mean height of the camera, metres");
  fields.add("body_radius_m", config.body_radius_m, 0.f, 1.f,
             "kept from walls and tall furniture, half of it from low pieces, metres");
  fields.add("steps_per_s", config.steps_per_s, 0.1f, 5.f, "steps a second");
  fields.add("rise_m", config.rise_m, 0.f, 0.2f, "up and down with every step, metres");
  fields.add("sideways_m", config.sideways_m, 0.f, 0.2f,
             "to the sides with every second step, metres");
  fields.add("nod_rad", config.nod_rad, 0.f, 0.2f, "pitch with every step, radians");
  fields.add("roll_rad", config.roll_rad, 0.f, 0.2f, "roll with every second step, radians");
  fields.add("drift_m", config.drift_m, 0.f, 0.2f, "slow motion of the arms, metres");
  fields.add("drift_rad", config.drift_rad, 0.f, 0.2f, "slow turns of the hands, radians");
  fields.add("tremor_m", config.tremor_m, 0.f, 0.01f, "tremor of the hands, metres");
  fields.add("tremor_rad", config.tremor_rad, 0.f, 0.01f, "tremor of the hands, radians");
  fields.add("whip_rad_s", config.whip_rad_s, 0.f, 20.f,
             "fastest turn of a pan aside and back every few seconds, radians a second; 0: none");
}

Wobble::Wobble(Random& random, float lowest_hz, float highest_hz) {
  for (std::size_t i = 0; i < kWaves; ++i) {
    speed_rad_s_[i] = kRevolution_rad * random.uniform(lowest_hz, highest_hz);
    phase_rad_[i] = kRevolution_rad * random.uniform();
  }
}

double Wobble::at(double time_s) const {
  double sum = 0;
  for (std::size_t i = 0; i < kWaves; ++i)
    sum += std::sin(speed_rad_s_[i] * time_s + phase_rad_[i]);
  return sum / kWaves;
}

Walk::Walk(PlaneSpline path, PlaneSpline gaze, double seconds, std::uint64_t seed,
           const WalkConfig& config)
    : path_(std::move(path)), gaze_(std::move(gaze)), seconds_(seconds), config_(config) {
  Random random(seed, kWalkStream);
  step_phase_rad_ = kRevolution_rad * random.uniform();
  constexpr int kAxes = 6;
  for (int axis = 0; axis < kAxes; ++axis) {
    drift_.emplace_back(random, kDrift_hz[0], kDrift_hz[1]);
    tremor_.emplace_back(random, kTremor_hz[0], kTremor_hz[1]);
  }
}

Pose Walk::at(double time_s) const {
  const auto hand = [&](std::size_t axis, double drift, double tremor) {
    return drift * drift_[axis].at(time_s) + tremor * tremor_[axis].at(time_s);
  };
  const double step = kRevolution_rad * config_.steps_per_s * time_s + step_phase_rad_;
  const Eigen::Vector2d body = path_.at(time_s), gaze = gaze_.at(time_s);
  const Eigen::Vector2d right(std::sin(gaze.x()), -std::cos(gaze.x()));
  Eigen::Vector3d eye;
  eye.head<2>() = body + config_.sideways_m * std::sin(step / 2) * right;
  eye.z() = config_.eye_m + config_.rise_m * std::sin(step);
  for (int axis = 0; axis < 3; ++axis)
    eye[axis] += hand(static_cast<std::size_t>(axis), config_.drift_m, config_.tremor_m);
  const double yaw = gaze.x() + whip_rad(time_s, double{config_.whip_rad_s}) +
                     hand(3, config_.drift_rad, config_.tremor_rad);
  const double pitch =
      gaze.y() + config_.nod_rad * std::cos(step) + hand(4, config_.drift_rad, config_.tremor_rad);
  const double roll =
      config_.roll_rad * std::cos(step / 2) + hand(5, config_.drift_rad, config_.tremor_rad);
  return looking(eye, yaw, pitch, roll);
}

bool all_reachable(const SynthRoom& room, const WalkConfig& config,
                   const std::vector<Eigen::Vector2f>& points_m) {
  const WalkMap map = free_floor(room, config);
  return std::all_of(points_m.begin(), points_m.end(), [&](const Eigen::Vector2f& point) {
    const auto nearest = map.nearest_free(point);
    return nearest && (*nearest - point).norm() < kStandsThere_m;
  });
}

std::vector<Eigen::Vector2d> walking_round(const SynthRoom& room, const WalkConfig& config,
                                           double spacing_m) {
  const WalkMap map = free_floor(room, config);
  std::vector<Eigen::Vector2f> corners;
  for (std::size_t i = 0; i < room.zones.size(); ++i) {
    const RoomZone& before = room.zones[(i + room.zones.size() - 1) % room.zones.size()];
    add_corners(map, room.zones[i].floor_m, before.floor_m.center(), corners);
  }
  if (room.zones.empty()) {
    const Eigen::AlignedBox2f floor(Eigen::Vector2f::Zero(),
                                    Eigen::Vector2f(room.size_m.head<2>()));
    add_corners(map, floor, {room.size_m.x(), room.size_m.y() / 2}, corners);
  }
  std::vector<Eigen::Vector2d> points;
  for (const Eigen::Vector2f& point : even_loop(map, corners, static_cast<float>(spacing_m)))
    points.push_back(point.cast<double>());
  if (static_cast<double>(points.size()) * spacing_m < kLeastRound_m)
    throw Error(concat("room '", room.name, "' (seed ", room.seed, "): no way of ", kLeastRound_m,
                       " m through its furniture for a body of ", config.body_radius_m,
                       " m radius; choose another seed or room"));
  return points;
}

namespace {

/// Along the moments of a survey, one a second, looking where each says.
Walk surveying(const SynthRoom& room, const WalkConfig& config) {
  std::vector<Eigen::Vector2d> places, gazes;
  for (const SurveyMoment& moment : room.survey) {
    const Eigen::Vector2d ahead = (moment.target_m - moment.eye_m).cast<double>();
    double yaw = std::atan2(ahead.y(), ahead.x());
    if (!gazes.empty())
      yaw = gazes.back().x() + std::remainder(yaw - gazes.back().x(), kRevolution_rad);
    places.push_back(moment.eye_m.cast<double>());
    gazes.emplace_back(yaw, std::atan2(moment.target_height_m - config.eye_m, ahead.norm()));
  }
  const double round = static_cast<double>(places.size() - 1) * kSurveySpacing_s;
  const double seconds = config.seconds > 0 ? static_cast<double>(config.seconds) : round;
  return {PlaneSpline(std::move(places), kSurveySpacing_s, false),
          PlaneSpline(std::move(gazes), kSurveySpacing_s, false), seconds, room.seed, config};
}

}  // namespace

Walk plan_walk(const SynthRoom& room, const RayScene& scene, const PinholeCamera& camera,
               const WalkConfig& config) {
  if (!room.survey.empty()) return surveying(room, config);
  const PlaneSpline path(walking_round(room, config, config.speed_mps * kPathSpacing_s),
                         kPathSpacing_s, true);
  const double seconds = config.seconds > 0 ? config.seconds : path.seconds();
  std::vector<Eigen::Vector3d> stops;
  for (int i = 0; i * kGazeSpacing_s < seconds + kGazeSpacing_s; ++i) {
    const Eigen::Vector2d place = path.at(i * kGazeSpacing_s);
    stops.emplace_back(place.x(), place.y(), config.eye_m);
  }
  // Yaw and pitch may each turn by the reach.
  const double reach = config.max_turn_rad_s * kGazeSpacing_s / std::numbers::sqrt2;
  std::vector<Eigen::Vector2d> gazes;
  for (const Gaze& gaze : plan_gazes(room, scene, camera, stops, reach))
    gazes.emplace_back(gaze.yaw_rad, gaze.pitch_rad);
  return {path, PlaneSpline(gazes, kGazeSpacing_s, false), seconds, room.seed, config};
}

}  // namespace ovimap
