// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/recordings/furniture_portrait.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "ovimap/base/config.h"
#include "ovimap/synth/camera/sensor_noise.h"
#include "ovimap/synth/camera/trajectory.h"
#include "ovimap/synth/render/renderer.h"
#include "ovimap/synth/shapes/angles.h"
#include "ovimap/synth/shapes/mesh_parts.h"
#include "ovimap/synth/shapes/random.h"

namespace ovimap {
namespace {

constexpr float kFreeSpace_m = 2.2f;   // of the room beyond the object
constexpr float kHangingTop_m = 2.1f;  // what reaches higher hangs from the ceiling
constexpr float kWallGap_m = 0.02f;
constexpr float kEyeMargin_m = 0.12f;  // between the camera and the room's surfaces
constexpr float kStudioLampHalf_m = 0.3f;
constexpr float kFreeStandingShare = 0.4f;  // of rooms where the object stands free
constexpr int kMostNeighbours = 3;
constexpr std::uint64_t kPatternStream = ~0ull;
constexpr const char* kSubject = "subject";
const std::array kFloors = {"oak", "walnut", "pine", "tiles", "carpet"};
const std::array kWalls = {"plaster", "plaster", "stripes", "dots"};

/// From where a thing is looked at.
enum class Place { kOnFloor, kAtWall, kOnTable, kOnWall, kHanging };

template <class List>
const auto& pick(const List& list, Random& random) {
  return list[random.index(list.size())];
}

/// What rooms are made from; made once, as it takes longer than a picture.
struct Patterns {
  const std::vector<SurfacePattern>&floors, &walls;
};

Rgb8 pale_color(Random& random) {
  const auto channel = [&] { return static_cast<std::uint8_t>(random.uniform(150.f, 245.f)); };
  return {channel(), channel(), channel()};
}

SurfaceMaterial random_material(const Patterns& patterns, Random& random) {
  SurfaceMaterial material;
  if (random.uniform() < 0.5f) material = textured(pick(patterns.floors, random));
  for (int i = 0; i < 3; ++i) material.albedo[i] = random.uniform(0.05f, 0.8f);
  return material;
}

/// A rectangle of the room, its pattern at its true size.
TexturedMesh covered_panel(const Eigen::Vector3f& corner, const Eigen::Vector3f& u,
                           const Eigen::Vector3f& v, const SurfacePattern& pattern) {
  TexturedMesh mesh;
  add_panel(mesh, corner, u, v, add_material(mesh, textured(pattern)), Eigen::Vector2f::Zero(),
            {u.norm() / pattern.width_m, v.norm() / pattern.height_m});
  return mesh;
}

Place place_of(const FurnitureEntry& entry, const Eigen::Vector3f& size, Random& random,
               const PortraitConfig& config) {
  if (entry.elevation_m + size.z() > kHangingTop_m && !entry.door_or_window) return Place::kHanging;
  if (entry.elevation_m > 0 || entry.door_or_window) return Place::kOnWall;
  if (size.maxCoeff() <= config.small_m) return Place::kOnTable;
  return random.uniform() < kFreeStandingShare ? Place::kOnFloor : Place::kAtWall;
}

/// One room with the object in it.
class PortraitRoom {
 public:
  PortraitRoom(const FurnitureEntry& entry, const TexturedMesh& model, const Patterns& patterns,
               const PortraitConfig& config, Random random)
      : patterns_(patterns), config_(config), random_(random), size_m_(bounds(model).sizes()) {
    place_ = place_of(entry, size_m_, random_, config);
    build_shell();
    place_subject(entry, model);
    if (place_ == Place::kOnTable) add_table();
    add_neighbours();
    add_lights();
    for (std::size_t i = 0; i < room_.objects.size(); ++i) {
      room_.objects[i].id = static_cast<std::uint16_t>(i + 1);
      if (room_.objects[i].class_name == kSubject) subject_ = room_.objects[i].id;
    }
    render_.exposure = random_.uniform(0.6f, 1.5f);
    renderer_.emplace(room_, render_);
  }
  PortraitRoom(const PortraitRoom&) = delete;
  PortraitRoom& operator=(const PortraitRoom&) = delete;

  std::optional<Portrait> draw() {
    for (int i = 0; i < config_.tries; ++i)
      if (auto portrait = try_draw()) return portrait;
    return std::nullopt;
  }

 private:
  void build_shell() {
    const float reach = size_m_.head<2>().norm() + kFreeSpace_m;
    room_.size_m = {reach + random_.uniform(0.f, 1.5f), reach + random_.uniform(0.f, 1.5f),
                    std::max(random_.uniform(2.4f, 2.9f), size_m_.z() + 0.2f)};
    const float w = room_.size_m.x(), d = room_.size_m.y(), h = room_.size_m.z();
    const Eigen::Vector3f x(w, 0, 0), y(0, d, 0), z(0, 0, h), origin(0, 0, 0);
    const SurfacePattern &plain = pick(patterns_.walls, random_),
                         &accent = pick(patterns_.walls, random_);
    add_object("floor", covered_panel(origin, x, y, pick(patterns_.floors, random_)));
    add_object("wall", covered_panel(y, x, z, accent));  // behind what stands at a wall
    add_object("wall", covered_panel(x + y, -y, z, plain));
    add_object("wall", covered_panel(x, -x, z, plain));
    add_object("wall", covered_panel(origin, y, z, plain));
    TexturedMesh ceiling;
    SurfaceMaterial paint;
    paint.albedo.setConstant(random_.uniform(0.6f, 0.9f));
    add_panel(ceiling, z, y, x, add_material(ceiling, paint));
    add_object("ceiling", std::move(ceiling));
  }

  void add_object(const char* class_name, TexturedMesh mesh) {
    RoomObject object;
    object.name = object.class_name = class_name;
    object.box = bounds(mesh);
    object.mesh = std::move(mesh);
    room_.objects.push_back(std::move(object));
  }

  void place_subject(const FurnitureEntry& entry, const TexturedMesh& model) {
    const Eigen::Vector3f& room = room_.size_m;
    box_.half_m = size_m_.head<2>() / 2;
    box_.center_m = room.head<2>() / 2;
    box_.bottom_m = std::min(entry.elevation_m, room.z() - size_m_.z());
    if (place_ == Place::kOnTable) box_.bottom_m = random_.uniform(0.65f, 0.95f);
    if (place_ == Place::kHanging) box_.bottom_m = room.z() - size_m_.z();
    if (place_ == Place::kOnFloor || place_ == Place::kOnTable)
      box_.yaw_rad = random_.uniform(-kPi, kPi);
    if (place_ == Place::kAtWall || place_ == Place::kOnWall) {
      box_.center_m.x() += random_.uniform(-0.4f, 0.4f);
      box_.center_m.y() = room.y() - size_m_.y() / 2 - kWallGap_m;
    }
    box_.top_m = box_.bottom_m + size_m_.z();
    add_object(kSubject, placed_mesh(model, box_));
  }

  void add_table() {
    const Eigen::Vector2f half(random_.uniform(0.3f, 0.7f), random_.uniform(0.3f, 0.6f));
    const Eigen::Vector2f middle = box_.center_m;
    TexturedMesh mesh;
    const auto material = add_material(mesh, random_material(patterns_, random_));
    add_box(mesh, {middle.x() - half.x(), middle.y() - half.y(), box_.bottom_m - 0.04f},
            {middle.x() + half.x(), middle.y() + half.y(), box_.bottom_m}, material);
    add_object("table", std::move(mesh));
  }

  /// Boxes beside the object, standing on what it stands on: something else is in most pictures.
  void add_neighbours() {
    if (place_ == Place::kOnWall || place_ == Place::kHanging) return;
    const float reach = size_m_.head<2>().norm() / 2, scale = std::max(size_m_.maxCoeff(), 0.1f);
    for (std::size_t left = random_.index(kMostNeighbours + 1); left > 0; --left) {
      const Eigen::Vector3f size(random_.uniform(0.2f, 0.8f) * scale,
                                 random_.uniform(0.2f, 0.8f) * scale,
                                 random_.uniform(0.1f, 0.9f) * scale);
      const float angle = random_.uniform(-kPi, kPi);
      const float away = reach + size.head<2>().norm() / 2 + random_.uniform(0.02f, 0.4f) * scale;
      OrientedBox box = box_;
      box.center_m += away * Eigen::Vector2f(std::cos(angle), std::sin(angle));
      box.half_m = size.head<2>() / 2;
      box.yaw_rad = random_.uniform(-kPi, kPi);
      box.top_m = box.bottom_m + size.z();
      if (!box.inside(room_.size_m.head<2>(), kWallGap_m)) continue;
      TexturedMesh mesh;
      const auto material = add_material(mesh, random_material(patterns_, random_));
      add_box(mesh, Eigen::Vector3f::Zero(), size, material);
      add_object("neighbour", placed_mesh(mesh, box));
    }
  }

  void add_lights() {
    const Eigen::Vector3f& room = room_.size_m;
    Eigen::Vector3f color(1.f, random_.uniform(0.88f, 1.f), random_.uniform(0.75f, 1.05f));
    color *= random_.uniform(0.15f, 0.35f) * room.x() * room.y();
    const Eigen::Vector3f center(random_.uniform(0.2f, 0.8f) * room.x(),
                                 random_.uniform(0.2f, 0.8f) * room.y(), room.z() - 0.02f);
    room_.lights.push_back({center,
                            {kStudioLampHalf_m, 0, 0},
                            {0, kStudioLampHalf_m, 0},
                            -Eigen::Vector3f::UnitZ(),
                            color});
    if (random_.uniform() < 0.5f) {  // daylight from the wall at x = 0
      const Eigen::Vector3f window(0.02f, random_.uniform(0.3f, 0.7f) * room.y(), 1.4f);
      room_.lights.push_back({window,
                              {0, 0.7f, 0},
                              {0, 0, 0.6f},
                              Eigen::Vector3f::UnitX(),
                              Eigen::Vector3f(1.5f, 1.6f, 1.7f) * random_.uniform(0.5f, 2.f)});
    }
    room_.ambient = Eigen::Vector3f(0.46f, 0.46f, 0.47f) * random_.uniform(0.6f, 1.3f);
  }

  /// Where the camera goes, seen from the object: turn about the vertical against the front, and
  /// height.
  std::array<float, 2> direction() {
    const bool all_round =
        place_ == Place::kOnTable || (place_ == Place::kOnFloor && random_.uniform() < 0.5f);
    const float half = all_round ? kPi : 1.2f;
    float low = 0.05f, high = 0.7f;
    if (place_ == Place::kOnTable) low = 0.2f, high = 0.95f;
    if (place_ == Place::kOnWall) low = -0.3f, high = 0.3f;
    if (place_ == Place::kHanging) low = -0.9f, high = -0.1f;
    return {random_.uniform(-half, half), random_.uniform(low, high)};
  }

  Pose camera_pose() {
    const auto [turn, height] = direction();
    const float share = random_.uniform(config_.least_share, config_.largest_share);
    const float away_m = size_m_.norm() / 2 / std::tan(share * config_.field_of_view_rad / 2);
    const float heading = box_.yaw_rad - kPi / 2 + turn;
    const Eigen::Vector3f outward(std::cos(height) * std::cos(heading),
                                  std::cos(height) * std::sin(heading), std::sin(height));
    const Eigen::Vector3f middle(box_.center_m.x(), box_.center_m.y(),
                                 (box_.bottom_m + box_.top_m) / 2);
    const Eigen::Vector3f margin = Eigen::Vector3f::Constant(kEyeMargin_m);
    const Eigen::Vector3f eye =
        (middle + away_m * outward).cwiseMax(margin).cwiseMin(room_.size_m - margin);
    const Eigen::Vector3f gaze = (middle - eye).normalized();
    const float sway = config_.field_of_view_rad * 0.08f;
    return looking(
        eye.cast<double>(), std::atan2(gaze.y(), gaze.x()) + random_.uniform(-sway, sway),
        std::asin(gaze.z()) + random_.uniform(-sway, sway), random_.uniform(-0.12f, 0.12f));
  }

  PinholeCamera camera() {
    const float low = std::log(static_cast<float>(config_.least_side_px)),
                high = std::log(static_cast<float>(config_.largest_side_px));
    const int side_px = static_cast<int>(std::lround(std::exp(random_.uniform(low, high))));
    const float side = static_cast<float>(side_px);
    const float focal_px = 0.5f * side / std::tan(config_.field_of_view_rad / 2);
    return {side_px, side_px, focal_px, focal_px, 0.5f * (side - 1), 0.5f * (side - 1)};
  }

  std::optional<Portrait> try_draw() {
    const PinholeCamera shot = camera();
    const Pose pose = camera_pose();
    const std::uint64_t noise_seed = random_.bits();
    const IdImage ids = renderer_->render(shot, pose, false).ids;
    Eigen::AlignedBox2i seen;
    int visible_px = 0;
    for (int y = 0; y < ids.height(); ++y)
      for (int x = 0; x < ids.width(); ++x)
        if (ids.at(x, y) == subject_) seen.extend(Eigen::Vector2i(x, y)), ++visible_px;
    if (visible_px < config_.least_visible_px) return std::nullopt;
    const RgbImage color =
        noisy_color(renderer_->render(shot, pose).color, SensorNoiseConfig{}, noise_seed);
    return cut_out(color, ids, seen);
  }

  Portrait cut_out(const RgbImage& color, const IdImage& ids, const Eigen::AlignedBox2i& seen) {
    const Eigen::Vector2i side = seen.sizes() + Eigen::Vector2i::Ones();
    const Eigen::Vector2i margin = (side.cast<float>() * config_.margin).cast<int>();
    const Eigen::Vector2i low = (seen.min() - margin).cwiseMax(0);
    const Eigen::Vector2i high =
        (seen.max() + margin).cwiseMin(Eigen::Vector2i(color.width() - 1, color.height() - 1));
    Portrait portrait{RgbImage(high.x() - low.x() + 1, high.y() - low.y() + 1),
                      Image<std::uint16_t>(high.x() - low.x() + 1, high.y() - low.y() + 1)};
    for (int y = low.y(); y <= high.y(); ++y)
      for (int x = low.x(); x <= high.x(); ++x) {
        portrait.color.at(x - low.x(), y - low.y()) = color.at(x, y);
        portrait.visible.at(x - low.x(), y - low.y()) = ids.at(x, y) == subject_ ? 255 : 0;
      }
    return portrait;
  }

  const Patterns& patterns_;
  const PortraitConfig& config_;
  Random random_;
  Eigen::Vector3f size_m_;
  Place place_ = Place::kOnFloor;
  OrientedBox box_;
  SynthRoom room_;
  std::uint16_t subject_ = 0;
  RenderConfig render_;
  std::optional<Renderer> renderer_;
};

}  // namespace

void list_fields(PortraitConfig& config, ConfigFields& fields) {
  fields.add("views", config.views, 1, 10000, "pictures of a model");
  fields.add("views_per_room", config.views_per_room, 1, 10000,
             "pictures before walls, floor and light change");
  fields.add("patterns", config.patterns, 1, 1000, "different floors, and different walls");
  fields.add("least_side_px", config.least_side_px, 16, 4096, "smallest drawn image");
  fields.add("largest_side_px", config.largest_side_px, 16, 4096, "largest drawn image");
  fields.add("field_of_view_rad", config.field_of_view_rad, 0.1f, 2.5f, "of the camera");
  fields.add("least_share", config.least_share, 0.05f, 1.5f,
             "share of the field of view that the object takes, at least");
  fields.add("largest_share", config.largest_share, 0.05f, 1.5f, "and at most");
  fields.add("margin", config.margin, 0.f, 2.f, "kept around the object, of its sides");
  fields.add("small_m", config.small_m, 0.f, 10.f, "up to this size a thing stands on a table");
  fields.add("largest_m", config.largest_m, 0.1f, 100.f, "larger models are left out");
  fields.add("least_visible_px", config.least_visible_px, 1, 1000000,
             "fewer pixels are no view of the object");
  fields.add("tries", config.tries, 1, 1000, "camera places tried for a view");
}

PortraitStudio::PortraitStudio(std::uint64_t seed, const PortraitConfig& config)
    : seed_(seed), config_(config) {
  Random random(seed, kPatternStream);
  for (int i = 0; i < config.patterns; ++i) {
    floors_.push_back(floor_pattern(pick(kFloors, random), random.bits()));
    const Rgb8 color = pale_color(random);
    walls_.push_back(wall_pattern(pick(kWalls, random), color, random.bits()));
  }
}

std::vector<Portrait> PortraitStudio::draw(const FurnitureEntry& entry, const TexturedMesh& model,
                                           std::uint64_t number) const {
  std::vector<Portrait> portraits;
  if (model.vertices.empty() || bounds(model).sizes().maxCoeff() > config_.largest_m)
    return portraits;
  const Patterns patterns{floors_, walls_};
  const std::uint64_t seed = Random(seed_, number).bits();
  for (int view = 0, stream = 0; view < config_.views; ++stream) {
    const Random random(seed, static_cast<std::uint64_t>(stream));
    PortraitRoom room(entry, model, patterns, config_, random);
    for (int i = 0; i < config_.views_per_room && view < config_.views; ++i, ++view)
      if (auto portrait = room.draw()) portraits.push_back(std::move(*portrait));
  }
  return portraits;
}

}  // namespace ovimap
