// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/recordings/figure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "ovimap/base/config.h"
#include "ovimap/synth/camera/walk_path.h"
#include "ovimap/synth/shapes/mesh_parts.h"
#include "ovimap/synth/shapes/random.h"
#include "ovimap/synth/shapes/solids.h"

namespace ovimap {
namespace {

constexpr std::uint64_t kFigureStream = 14001;
constexpr int kPostures = 8, kCorners = 6;
constexpr float kWaySpacing_m = 0.05f, kLeastWay_m = 1.f;
constexpr float kSwing_rad = 0.45f;
// Of a figure one metre tall: places of joints and radii of limbs.
constexpr float kHip = 0.52f, kKnee = 0.27f, kShoulder = 0.82f, kElbow = 0.66f, kHead = 0.93f;
constexpr float kHipSide = 0.055f, kShoulderSide = 0.12f, kLeg = 0.045f, kArm = 0.028f;

Eigen::Vector3f below(const Eigen::Vector3f& joint, float length, float swing_rad) {
  return joint + length * Eigen::Vector3f(std::sin(swing_rad), 0, -std::cos(swing_rad));
}

void add_leg(TexturedMesh& mesh, float side, float swing_rad, std::uint32_t cloth) {
  const Eigen::Vector3f hip(0, side * kHipSide, kHip);
  const Eigen::Vector3f knee = below(hip, kHip - kKnee, swing_rad);
  const Eigen::Vector3f foot = below(knee, kKnee - kLeg, swing_rad - std::abs(swing_rad) * 0.7f);
  add_bar(mesh, std::array{hip, knee, foot}, kLeg, cloth);
}

void add_arm(TexturedMesh& mesh, float side, std::uint32_t cloth) {
  const Eigen::Vector3f shoulder(0, side * kShoulderSide, kShoulder),
      elbow(0.03f, side * (kShoulderSide + 0.02f), kElbow), hand(0.17f, side * 0.1f, kElbow);
  add_bar(mesh, std::array{shoulder, elbow, hand}, kArm, cloth);
}

std::uint32_t add_color(TexturedMesh& mesh, Random& random) {
  SurfaceMaterial material;
  for (float& channel : material.albedo) channel = random.uniform(0.1f, 0.7f);
  return add_material(mesh, material);
}

TexturedMesh person_mesh(float phase, std::uint64_t seed) {
  Random random(seed);
  TexturedMesh mesh;
  const std::uint32_t shirt = add_color(mesh, random), trousers = add_color(mesh, random),
                      skin = add_color(mesh, random);
  const float swing = kSwing_rad * std::sin(2 * std::numbers::pi_v<float> * phase);
  add_leg(mesh, 1, swing, trousers);
  add_leg(mesh, -1, -swing, trousers);
  add_rounded_box(mesh, {-0.065f, -0.11f, kHip - 0.03f}, {0.065f, 0.11f, kShoulder + 0.02f}, 0.05f,
                  shirt);
  add_arm(mesh, 1, shirt);
  add_arm(mesh, -1, shirt);
  add_rounded_box(mesh, {-0.05f, -0.045f, kHead - 0.1f}, {0.06f, 0.045f, 1}, 0.045f, skin);
  return mesh;
}

TexturedMesh carton_mesh(std::uint64_t seed) {
  Random random(seed, 1);
  TexturedMesh mesh;
  add_box(mesh, {0.1f, -0.1f, kElbow - 0.05f}, {0.26f, 0.1f, kElbow + 0.09f},
          add_color(mesh, random));
  return mesh;
}

RoomObject object_of(TexturedMesh mesh, float height_m, std::uint16_t id, const char* name,
                     const char* class_name) {
  RoomObject object;
  object.id = id;
  object.name = name;
  object.class_name = class_name;
  object.mesh = moved(std::move(mesh), Eigen::Affine3f(Eigen::Scaling(height_m)));
  object.box = bounds(object.mesh);
  return object;
}

std::vector<Eigen::Vector2f> plan_way(const SynthRoom& room, const FigureConfig& config,
                                      TrajectoryConfig walk, std::uint64_t seed) {
  walk.body_radius_m = config.radius_m;
  const WalkMap map(room, walk);
  Random random(seed, kFigureStream);
  std::vector<Eigen::Vector2f> corners;
  for (int i = 0; i < kCorners; ++i) {
    const Eigen::Vector2f point(random.uniform(0, room.size_m.x()),
                                random.uniform(0, room.size_m.y()));
    if (const auto free = map.nearest_free(point)) corners.push_back(*free);
  }
  auto way = corners.empty() ? corners : even_loop(map, corners, kWaySpacing_m);
  if (static_cast<float>(way.size()) * kWaySpacing_m < kLeastWay_m)
    throw Error(concat("room '", room.name,
                       "' has no floor on which a figure could walk; leave "
                       "--figure away, or give another --room or --seed"));
  return way;
}

}  // namespace

void list_fields(FigureConfig& config, ConfigFields& fields) {
  fields.add("height_m", config.height_m, 0.3f, 3.f, "of the figure, metres");
  fields.add("speed_mps", config.speed_mps, 0.f, 5.f, "how fast it walks, metres a second");
  fields.add("stride_m", config.stride_m, 0.1f, 3.f, "length of a step, metres");
  fields.add("picture_s", config.picture_s, 0.f, 100.f,
             "time between two pictures that are no video, seconds");
  fields.add("radius_m", config.radius_m, 0.05f, 2.f,
             "kept between it and walls or tall furniture, metres");
}

Figure::Figure(const SynthRoom& room, const FigureConfig& config, const TrajectoryConfig& walk,
               std::uint64_t seed)
    : config_(config), way_(plan_way(room, config, walk, seed)) {
  along_m_.push_back(0);
  for (std::size_t i = 0; i < way_.size(); ++i)
    along_m_.push_back(along_m_.back() +
                       static_cast<double>((way_[(i + 1) % way_.size()] - way_[i]).norm()));
  const auto id = static_cast<std::uint16_t>(room.objects.size() + 1);
  for (int i = 0; i < kPostures; ++i) {
    auto& objects = postures_.emplace_back();
    const float phase = static_cast<float>(i) / kPostures;
    objects.push_back(object_of(person_mesh(phase, seed), config.height_m, id, "Figure", "person"));
    objects.push_back(object_of(carton_mesh(seed), config.height_m,
                                static_cast<std::uint16_t>(id + 1), "Carried carton", "carton"));
  }
  for (const auto& objects : postures_) tracers_.emplace_back(objects);
}

MovingThing Figure::at(double time_s) const {
  const double gone_m = time_s * static_cast<double>(config_.speed_mps);
  const double place_m = std::fmod(gone_m, along_m_.back());
  const auto after = std::upper_bound(along_m_.begin(), along_m_.end() - 1, place_m);
  const auto next = static_cast<std::size_t>(after - along_m_.begin()), at = next - 1;
  const auto part = static_cast<float>((place_m - along_m_[at]) / (along_m_[next] - along_m_[at]));
  const Eigen::Vector2f point = way_[at] + part * (way_[next % way_.size()] - way_[at]);
  const Eigen::Vector2f ahead = way_[(at + 4) % way_.size()] - point;
  const double turns = gone_m / (2 * static_cast<double>(config_.stride_m));
  const auto posture = static_cast<std::size_t>((turns - std::floor(turns)) * kPostures);
  MovingThing thing{&tracers_[posture % kPostures], Pose::Identity()};
  thing.world_from_thing.translation() << static_cast<double>(point.x()),
      static_cast<double>(point.y()), 0.;
  thing.world_from_thing.linear() =
      Eigen::AngleAxisd(std::atan2(static_cast<double>(ahead.y()), static_cast<double>(ahead.x())),
                        Eigen::Vector3d::UnitZ())
          .matrix();
  return thing;
}

}  // namespace ovimap
