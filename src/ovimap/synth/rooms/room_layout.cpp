// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/rooms/room_layout.h"

#include <algorithm>
#include <cmath>

#include "ovimap/base/config.h"
#include "ovimap/synth/shapes/angles.h"

namespace ovimap {
namespace {

constexpr float kRestGap_m = 5e-4f;       // things stand this far above what carries them
constexpr float kSink_m = 0.03f;          // soft things go this deep into it
constexpr float kMiddleShare = 0.5f;      // of the room, where middle pieces have their centre
constexpr float kFloorNearWall_m = 0.9f;  // small things on the floor lie within this of a wall
constexpr float kLongSide_m = 1.2f;       // a table side this long takes two chairs

OrientedBox box_of(const Eigen::Vector3f& size_m, const Eigen::Vector2f& center, float yaw,
                   float bottom) {
  return {center, size_m.head<2>() / 2, yaw, bottom, bottom + size_m.z()};
}

bool collide(const OrientedBox& a, const OrientedBox& b, float gap_m) {
  const float vertical = std::min(a.top_m, b.top_m) - std::max(a.bottom_m, b.bottom_m);
  return vertical > 0 && footprint_overlap(a, b) > -gap_m;
}

}  // namespace

void list_fields(LayoutConfig& config, ConfigFields& fields) {
  fields.add("tries", config.tries, 1, 100000, "random places tried for each piece");
  fields.add("gap_m", config.gap_m, 0.f, 1.f, "least distance between pieces on the floor, metres");
  fields.add("wall_gap_m", config.wall_gap_m, 0.f, 1.f,
             "between a piece and the wall behind it, metres");
  fields.add("front_clearance_m", config.front_clearance_m, 0.f, 5.f,
             "kept free in front of pieces along the walls, metres");
  fields.add("door_clearance_m", config.door_clearance_m, 0.f, 5.f,
             "kept free in front of doors, metres");
  fields.add("chair_gap_m", config.chair_gap_m, 0.f, 1.f, "between a chair and its table, metres");
  fields.add("surface_gap_m", config.surface_gap_m, 0.f, 1.f,
             "between things on one surface, metres");
  fields.add("surface_tolerance_m", config.surface_tolerance_m, 0.f, 0.1f,
             "unevenness under a thing on a surface, metres");
  fields.add("soft_tolerance_m", config.soft_tolerance_m, 0.f, 0.5f,
             "the same under pillows and blankets, which sink in, metres");
  fields.add("yaw_jitter_rad", config.yaw_jitter_rad, 0.f, kPi,
             "how carelessly chairs and small things are turned, radians");
}

std::array<WallLine, 4> wall_lines(const Eigen::Vector2f& size) {
  return {{{"south wall", {0, 0}, {1, 0}, {0, 1}, size.x()},
           {"east wall", {size.x(), 0}, {0, 1}, {-1, 0}, size.y()},
           {"north wall", {size.x(), size.y()}, {-1, 0}, {0, -1}, size.x()},
           {"west wall", {0, size.y()}, {0, -1}, {1, 0}, size.y()}}};
}

float yaw_facing(const Eigen::Vector2f& direction) {
  return std::atan2(direction.x(), -direction.y());
}

RoomLayout::RoomLayout(const Eigen::Vector3f& room_size_m, std::uint64_t seed,
                       const LayoutConfig& config)
    : room_size_m_(room_size_m), config_(config), random_(seed) {}

bool RoomLayout::free_of_pieces(const OrientedBox& box) const {
  if (!box.inside(room_size_m_.head<2>(), 0) || box.top_m > room_size_m_.z()) return false;
  return std::none_of(pieces_.begin(), pieces_.end(),
                      [&](const OrientedBox& other) { return collide(box, other, config_.gap_m); });
}

bool RoomLayout::fits(const OrientedBox& box) const {
  return free_of_pieces(box) &&
         std::none_of(clear_.begin(), clear_.end(),
                      [&](const OrientedBox& space) { return overlap(box, space) > 0; });
}

OrientedBox RoomLayout::at_wall(const WallLine& wall, float position_m, float gap_m,
                                const Eigen::Vector3f& size_m) const {
  const Eigen::Vector2f center =
      wall.start_m + position_m * wall.along + (gap_m + size_m.y() / 2) * wall.inward;
  return box_of(size_m, center, yaw_facing(wall.inward), 0);
}

std::optional<OrientedBox> RoomLayout::against_wall(const Eigen::Vector3f& size_m) {
  const auto walls = wall_lines(room_size_m_.head<2>());
  for (int i = 0; i < config_.tries; ++i) {
    const WallLine& wall = walls[random_.index(walls.size())];
    const float half = size_m.x() / 2 + config_.wall_gap_m;
    const float position = random_.uniform(half, wall.length_m - half);
    const OrientedBox box = at_wall(wall, position, config_.wall_gap_m, size_m);
    const OrientedBox front = space_in_front(box, config_.front_clearance_m);
    if (fits(box) && free_of_pieces(front)) return box;
  }
  return std::nullopt;
}

std::optional<OrientedBox> RoomLayout::in_corner(const Eigen::Vector3f& size_m) {
  const auto walls = wall_lines(room_size_m_.head<2>());
  for (int i = 0; i < config_.tries; ++i) {
    const WallLine& wall = walls[random_.index(walls.size())];
    const float gap = config_.wall_gap_m + random_.uniform(0, config_.gap_m);
    const OrientedBox box = at_wall(wall, gap + size_m.x() / 2, gap, size_m);
    if (fits(box)) return box;
  }
  return std::nullopt;
}

std::optional<OrientedBox> RoomLayout::in_middle(const Eigen::Vector3f& size_m) {
  const Eigen::Vector2f room = room_size_m_.head<2>();
  for (int i = 0; i < config_.tries; ++i) {
    const Eigen::Vector2f part(random_.uniform(-0.5f, 0.5f), random_.uniform(-0.5f, 0.5f));
    const float yaw = random_.index(2) == 0 ? 0.f : kPi / 2;
    const OrientedBox box =
        box_of(size_m, room / 2 + kMiddleShare * part.cwiseProduct(room), yaw, 0);
    if (fits(box)) return box;
  }
  return std::nullopt;
}

std::optional<OrientedBox> RoomLayout::on_floor(const Eigen::Vector3f& size_m) {
  const auto walls = wall_lines(room_size_m_.head<2>());
  for (int i = 0; i < config_.tries; ++i) {
    const WallLine& wall = walls[random_.index(walls.size())];
    const Eigen::Vector2f center = wall.start_m + random_.uniform(0, wall.length_m) * wall.along +
                                   random_.uniform(0, kFloorNearWall_m) * wall.inward;
    const OrientedBox box = box_of(size_m, center, random_.uniform(-kPi, kPi), 0);
    if (box.inside(room_size_m_.head<2>(), config_.wall_gap_m) && fits(box)) return box;
  }
  return std::nullopt;
}

std::optional<OrientedBox> RoomLayout::on_wall(const Eigen::Vector3f& size_m, float bottom_m,
                                               const std::array<bool, 4>& allowed) {
  const auto walls = wall_lines(room_size_m_.head<2>());
  for (int i = 0; i < config_.tries; ++i) {
    const std::size_t number = random_.index(walls.size());
    const WallLine& wall = walls[number];
    const float half = size_m.x() / 2 + config_.gap_m;
    OrientedBox box =
        at_wall(wall, random_.uniform(half, wall.length_m - half), kRestGap_m, size_m);
    box.bottom_m += bottom_m;
    box.top_m += bottom_m;
    if (allowed[number] && fits(box)) return box;
  }
  return std::nullopt;
}

std::optional<OrientedBox> RoomLayout::around(const OrientedBox& table,
                                              const Eigen::Vector3f& size_m) {
  for (int i = 0; i < config_.tries; ++i) {
    const bool long_side = (table.half_m.x() >= table.half_m.y()) == (random_.index(4) != 0);
    const float sign = random_.index(2) == 0 ? 1.f : -1.f;
    const int across = long_side ? 1 : 0, along = 1 - across;  // axes of the table's own frame
    const float length = 2 * table.half_m[along];
    Eigen::Vector2f place = Eigen::Vector2f::Zero(), outward = Eigen::Vector2f::Zero();
    outward[across] = sign;
    place[across] = sign * (table.half_m[across] + size_m.y() / 2 + config_.chair_gap_m +
                            random_.uniform(0, 2 * config_.chair_gap_m));
    place[along] = length < kLongSide_m ? 0.f : (random_.index(2) == 0 ? 0.25f : -0.25f) * length;
    place[along] += random_.uniform(-config_.chair_gap_m, config_.chair_gap_m);
    const Eigen::Vector2f facing = -(outward.x() * table.x_axis() + outward.y() * table.y_axis());
    const float turn = random_.uniform(-config_.yaw_jitter_rad, config_.yaw_jitter_rad);
    const OrientedBox box =
        box_of(size_m, table.world_from_box(place), yaw_facing(facing) + turn, 0);
    if (fits(box)) return box;
  }
  return std::nullopt;
}

std::optional<OrientedBox> RoomLayout::on_top(std::size_t support, const HeightMap& upper_side,
                                              const Eigen::Vector3f& size_m, bool aligned,
                                              bool soft) {
  const OrientedBox carrier = pieces_[support];
  const float tolerance_m = soft ? config_.soft_tolerance_m : config_.surface_tolerance_m;
  const float lift_m = soft ? -kSink_m : kRestGap_m;
  for (int i = 0; i < config_.tries; ++i) {
    const float turn = aligned ? random_.uniform(-config_.yaw_jitter_rad, config_.yaw_jitter_rad)
                               : random_.uniform(-kPi, kPi);
    const Eigen::Vector2f part(random_.uniform(-1, 1), random_.uniform(-1, 1));
    const OrientedBox local = box_of(size_m, part.cwiseProduct(carrier.half_m), turn, 0);
    const auto height = upper_side.rest(local, tolerance_m);
    if (!height) continue;
    const OrientedBox box = box_of(size_m, carrier.world_from_box(local.center_m),
                                   carrier.yaw_rad + turn, *height + lift_m);
    bool free =
        box.inside(room_size_m_.head<2>(), config_.wall_gap_m) && box.top_m < room_size_m_.z();
    for (std::size_t k = 0; free && k < pieces_.size(); ++k)
      free = k == support || !collide(box, pieces_[k], config_.surface_gap_m);
    if (free) return box;
  }
  return std::nullopt;
}

std::size_t RoomLayout::add(const OrientedBox& box) {
  pieces_.push_back(box);
  return pieces_.size() - 1;
}

OrientedBox RoomLayout::space_in_front(const OrientedBox& box, float reach_m) {
  OrientedBox space = box;
  space.center_m = box.world_from_box({0, -box.half_m.y() - reach_m / 2});
  space.half_m.y() = reach_m / 2;
  return space;
}

}  // namespace ovimap
