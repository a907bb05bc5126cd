// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/rooms/room_shell.h"

#include <algorithm>

#include "ovimap/synth/rooms/room_layout.h"
#include "ovimap/synth/shapes/mesh_parts.h"
#include "ovimap/synth/shapes/random.h"
#include "ovimap/synth/shapes/surface_patterns.h"

namespace ovimap {
namespace {

constexpr float kSkirtingHeight_m = 0.08f, kSkirtingDepth_m = 0.012f;
constexpr float kPictureFrame_m = 0.03f;
constexpr float kOutdoorGlow = 1.6f;
const Eigen::Vector3f kSkirtingColor(0.75f, 0.73f, 0.69f);
const Eigen::Vector3f kCeilingColor(0.82f, 0.81f, 0.79f);

enum ShellStream : std::uint64_t { kFloorStream = 101, kWallStream = 102 };

Eigen::Vector3f at_height(const Eigen::Vector2f& plan, float z) {
  return {plan.x(), plan.y(), z};
}

RoomObject shell_object(const std::string& name, const std::string& class_name, TexturedMesh mesh) {
  RoomObject object;
  object.name = name;
  object.class_name = class_name;
  object.box = bounds(mesh);
  object.mesh = std::move(mesh);
  return object;
}

RoomObject floor_object(const RoomSpec& spec) {
  const SurfacePattern pattern =
      floor_pattern(spec.floor_style, Random(spec.seed, kFloorStream).bits());
  TexturedMesh mesh;
  const auto material = add_material(mesh, textured(pattern));
  const Eigen::Vector2f repeats(spec.size_m.x() / pattern.width_m,
                                spec.size_m.y() / pattern.height_m);
  add_panel(mesh, {0, 0, 0}, {spec.size_m.x(), 0, 0}, {0, spec.size_m.y(), 0}, material,
            Eigen::Vector2f::Zero(), repeats);
  return shell_object("floor", "floor", std::move(mesh));
}

RoomObject ceiling_object(const RoomSpec& spec) {
  TexturedMesh mesh;
  SurfaceMaterial paint;
  paint.albedo = kCeilingColor;
  const auto material = add_material(mesh, paint);
  add_panel(mesh, {0, 0, spec.size_m.z()}, {0, spec.size_m.y(), 0}, {spec.size_m.x(), 0, 0},
            material);
  return shell_object("ceiling", "ceiling", std::move(mesh));
}

/// A part of a wall, seen from inside.
struct WallPart {
  float from_m, to_m;  ///< along the wall
  float bottom_m, top_m;
};

/// What doorways leave of a wall: the parts between them, which stand on the floor, then the parts
/// above them.
std::vector<WallPart> parts_of(const RoomSpec& spec, std::size_t number, float length_m) {
  std::vector<Doorway> doorways;
  for (const Doorway& doorway : spec.doorways)
    if (doorway.wall == number) doorways.push_back(doorway);
  std::sort(doorways.begin(), doorways.end(),
            [](const Doorway& a, const Doorway& b) { return a.center_m < b.center_m; });
  std::vector<WallPart> parts, lintels;
  float from = 0;
  for (const Doorway& doorway : doorways) {
    const float left = doorway.center_m - doorway.width_m / 2, right = left + doorway.width_m;
    parts.push_back({from, left, 0, spec.size_m.z()});
    lintels.push_back({left, right, doorway.height_m, spec.size_m.z()});
    from = right;
  }
  parts.push_back({from, length_m, 0, spec.size_m.z()});
  parts.insert(parts.end(), lintels.begin(), lintels.end());
  return parts;
}

RoomObject wall_object(const RoomSpec& spec, std::size_t number, const WallLine& wall,
                       const SurfacePattern& pattern) {
  TexturedMesh mesh;
  const auto surface = add_material(mesh, textured(pattern));
  SurfaceMaterial skirting;
  skirting.albedo = kSkirtingColor;
  const auto board = add_material(mesh, skirting);
  const Eigen::Vector3f out = at_height(wall.inward * kSkirtingDepth_m, 0);
  for (const WallPart& part : parts_of(spec, number, wall.length_m)) {
    // Seen from inside, `along` runs to the left: the normal along x up points outwards.
    const Eigen::Vector3f along = at_height(wall.along * (part.to_m - part.from_m), 0);
    const Eigen::Vector3f start = at_height(wall.start_m + wall.along * part.from_m, 0);
    add_panel(mesh, start + along + Eigen::Vector3f(0, 0, part.bottom_m), -along,
              Eigen::Vector3f(0, 0, part.top_m - part.bottom_m), surface,
              {(wall.length_m - part.to_m) / pattern.width_m, part.bottom_m / pattern.height_m},
              {(wall.length_m - part.from_m) / pattern.width_m, part.top_m / pattern.height_m});
    if (part.bottom_m > 0) continue;
    const Eigen::Vector3f board_up(0, 0, kSkirtingHeight_m);
    add_panel(mesh, start + along + out, -along, board_up, board);
    add_panel(mesh, start + board_up, along, out, board);
  }
  return shell_object(wall.name, "wall", std::move(mesh));
}

}  // namespace

std::vector<RoomObject> room_shell(const RoomSpec& spec) {
  std::vector<RoomObject> objects = {floor_object(spec)};
  const auto walls = wall_lines(spec.size_m.head<2>());
  const std::uint64_t seed = Random(spec.seed, kWallStream).bits();
  const SurfacePattern plain = wall_pattern(spec.wall_style, spec.wall_color, seed);
  const SurfacePattern accent = wall_pattern(spec.accent_style, spec.accent_color, seed);
  for (std::size_t i = 0; i < walls.size(); ++i)
    objects.push_back(
        wall_object(spec, i, walls[i], i == spec.seed % walls.size() ? accent : plain));
  objects.push_back(ceiling_object(spec));
  return objects;
}

TexturedMesh picture_model(const Eigen::Vector3f& size, std::uint64_t seed) {
  TexturedMesh mesh;
  SurfaceMaterial wood;
  wood.albedo = Eigen::Vector3f(0.08f, 0.05f, 0.03f) * (1 + 4 * Random(seed).uniform());
  const auto frame = add_material(mesh, wood);
  const float x = size.x() / 2, y = size.y() / 2, w = kPictureFrame_m;
  add_box(mesh, {-x, -y, 0}, {-x + w, y, size.z()}, frame);
  add_box(mesh, {x - w, -y, 0}, {x, y, size.z()}, frame);
  add_box(mesh, {-x + w, -y, 0}, {x - w, y, w}, frame);
  add_box(mesh, {-x + w, -y, size.z() - w}, {x - w, y, size.z()}, frame);
  const float width = size.x() - 2 * w, height = size.z() - 2 * w;
  const auto canvas = add_material(mesh, textured(painting_pattern(width, height, seed)));
  add_panel(mesh, {-x + w, -y / 2, w}, {width, 0, 0}, {0, 0, height}, canvas);
  return mesh;
}

TexturedMesh rug_model(const Eigen::Vector3f& size, std::uint64_t seed) {
  TexturedMesh mesh;
  SurfaceMaterial wool;
  wool.albedo = Eigen::Vector3f(0.2f, 0.17f, 0.14f);
  add_box(mesh, {-size.x() / 2, -size.y() / 2, 0}, {size.x() / 2, size.y() / 2, size.z()},
          add_material(mesh, wool));
  // The pattern lies on the upper side, a hair above it.
  const auto pile = add_material(mesh, textured(rug_pattern(size.x(), size.y(), seed)));
  const float top = size.z() * 1.02f;
  add_panel(mesh, {-size.x() / 2, -size.y() / 2, top}, {size.x(), 0, 0}, {0, size.y(), 0}, pile);
  return mesh;
}

TexturedMesh outdoor_model(const Eigen::Vector3f& size, std::uint64_t seed) {
  TexturedMesh mesh;
  SurfaceMaterial view = textured(outdoor_pattern(size.x(), size.z(), seed));
  view.emission.setConstant(kOutdoorGlow);
  add_panel(mesh, {-size.x() / 2, 0, 0}, {size.x(), 0, 0}, {0, 0, size.z()},
            add_material(mesh, view));
  return mesh;
}

}  // namespace ovimap
