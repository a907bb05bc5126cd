// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/buildings/visits.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "ovimap/base/config.h"
#include "ovimap/synth/rooms/room_layout.h"
#include "ovimap/synth/shapes/mesh_parts.h"
#include "ovimap/synth/shapes/random.h"

namespace ovimap {
namespace {

constexpr std::uint64_t kVisitStream = 12001;
constexpr float kStands_m = 0.02f;      // so near above what carries it a thing rests on it
constexpr float kOnFloor_m = 0.02f;     // what lies lower stands on the floor
constexpr float kLowestDeck_m = 0.25f;  // tops of furniture on which things are put down
constexpr float kHighestDeck_m = 1.3f;
constexpr int kPlaces = 20;  // tried for each thing

bool present(const RoomObject& object) {
  return !object.mesh.triangles.empty();
}

bool rests_on(const OrientedBox& thing, const OrientedBox& carrier) {
  return footprint_overlap(thing, carrier) > 0 && thing.bottom_m > carrier.bottom_m + kOnFloor_m &&
         thing.bottom_m < carrier.top_m + kStands_m;
}

/// A thing's mesh as the thing itself sees it: its footprint's middle at the origin, unturned.
TexturedMesh own_frame(const RoomObject& object) {
  const OrientedBox& box = *object.footprint;
  OrientedBox origin = box;
  origin.center_m.setZero();
  origin.yaw_rad = 0;
  TexturedMesh mesh = object.mesh;
  const Eigen::Matrix3f turn =
      Eigen::AngleAxisf(-box.yaw_rad, Eigen::Vector3f::UnitZ()).toRotationMatrix();
  const Eigen::Vector3f center(box.center_m.x(), box.center_m.y(), 0);
  for (Eigen::Vector3f& vertex : mesh.vertices) vertex = turn * (vertex - center);
  return mesh;
}

Pose pose_of(const OrientedBox& box) {
  Pose pose = Pose::Identity();
  pose.linear() =
      Eigen::AngleAxisd(static_cast<double>(box.yaw_rad), Eigen::Vector3d::UnitZ()).matrix();
  pose.translation() =
      Eigen::Vector3f(box.center_m.x(), box.center_m.y(), box.bottom_m).cast<double>();
  return pose;
}

/// Moves the object.
RoomChange moved(RoomObject& object, const OrientedBox& place) {
  RoomChange change{RoomChangeKind::kMoved, object.id, object.box, {}};
  change.new_from_old = pose_of(place) * pose_of(*object.footprint).inverse();
  const Eigen::Isometry3f new_from_old = change.new_from_old.cast<float>();
  for (Eigen::Vector3f& vertex : object.mesh.vertices) vertex = new_from_old * vertex;
  for (Eigen::Vector3f& normal : object.mesh.normals) normal = new_from_old.linear() * normal;
  change.to = object.box = bounds(object.mesh);
  object.footprint = place;
  return change;
}

void take_away(RoomObject& object) {
  object.mesh = {};
  object.box.setEmpty();
  object.footprint.reset();
}

/// The room between two visits. `kept`: the places of things that are yet to come.
class Rearranger {
 public:
  Rearranger(const SynthRoom& room, const VisitsConfig& config, std::uint64_t seed,
             std::vector<OrientedBox> kept = {})
      : room_(room), config_(config), random_(seed), kept_(std::move(kept)) {}

  /// Ids of the things that may be moved or carried off, in random order.
  std::vector<std::uint16_t> movable() {
    std::vector<std::uint16_t> ids;
    for (const RoomObject& object : room_.objects)
      if (present(object) && object.footprint && is_handy(*object.footprint) && stands(object) &&
          !shines(object) && !carries(object))
        ids.push_back(object.id);
    random_.shuffle(ids);
    return ids;
  }

  /// Another place for the thing; nothing where there is none.
  std::optional<OrientedBox> new_place(const RoomObject& object) {
    const OrientedBox& old = *object.footprint;
    const Eigen::Vector3f size(2 * old.half_m.x(), 2 * old.half_m.y(), old.top_m - old.bottom_m);
    const bool on_floor = old.bottom_m < kOnFloor_m;
    for (int i = 0; i < kPlaces; ++i) {
      const auto place = on_floor ? floor_place(object, size) : deck_place(object, size);
      if (place && (place->center_m - old.center_m).norm() > config_.least_way_m &&
          footprint_overlap(*place, old) < 0)
        return place;
    }
    return std::nullopt;
  }

  /// Ids of the doors' leaves that turn, in random order.
  std::vector<std::uint16_t> doors() {
    std::vector<std::uint16_t> ids;
    for (const RoomObject& object : room_.objects)
      if (present(object) && object.hinge) ids.push_back(object.id);
    random_.shuffle(ids);
    return ids;
  }

  /// A leaf, opened further or less far; nothing where something stands in its way.
  std::optional<OrientedBox> other_angle(const RoomObject& door) {
    for (int i = 0; i < kPlaces; ++i) {
      const float open = random_.uniform(config_.least_open_rad, config_.most_open_rad);
      const float turn = door.hinge->shut_yaw_rad - open - door.footprint->yaw_rad;
      const OrientedBox place = door.footprint->turned(door.hinge->at_m, turn);
      if (std::abs(turn) >= config_.least_turn_rad && is_free(place, door.id)) return place;
    }
    return std::nullopt;
  }

 private:
  bool is_free(const OrientedBox& place, std::uint16_t id) const {
    return !any_other(id, [&](const OrientedBox& box) { return overlap(box, place) > 0; });
  }
  /// Whether the box of some other thing passes the test, also of one that is yet to come.
  template <class Test>
  bool any_other(std::uint16_t id, const Test& test) const {
    return std::any_of(kept_.begin(), kept_.end(), test) ||
           std::any_of(room_.objects.begin(), room_.objects.end(), [&](const RoomObject& other) {
             return other.footprint && other.id != id && test(*other.footprint);
           });
  }
  bool is_handy(const OrientedBox& box) const {
    return box.top_m - box.bottom_m >= config_.least_height_m &&
           2 * box.half_m.maxCoeff() >= config_.least_side_m &&
           4 * box.half_m.prod() <= config_.largest_footprint_m2 &&
           box.top_m - box.bottom_m <= config_.tallest_m;
  }
  bool stands(const RoomObject& object) const {
    const OrientedBox& box = *object.footprint;
    return box.bottom_m < kOnFloor_m ||
           std::any_of(room_.objects.begin(), room_.objects.end(), [&](const RoomObject& other) {
             return other.footprint && other.id != object.id && rests_on(box, *other.footprint);
           });
  }
  bool shines(const RoomObject& object) const {
    const Eigen::AlignedBox3f around(object.box.min().array() - kStands_m,
                                     object.box.max().array() + kStands_m);
    return std::any_of(room_.lights.begin(), room_.lights.end(),
                       [&](const AreaLight& light) { return around.contains(light.center_m); });
  }
  bool carries(const RoomObject& object) const {
    return any_other(object.id,
                     [&](const OrientedBox& box) { return rests_on(box, *object.footprint); });
  }

  RoomLayout layout_without(std::uint16_t id) {
    RoomLayout layout(room_.size_m, random_.bits());
    for (const OrientedBox& wall : room_.walls) layout.add(wall);
    for (const OrientedBox& place : kept_) layout.add(place);
    for (const RoomObject& object : room_.objects)
      if (object.footprint && object.id != id && object.footprint->top_m > kOnFloor_m)
        layout.add(*object.footprint);
    return layout;
  }
  std::optional<OrientedBox> floor_place(const RoomObject& object, const Eigen::Vector3f& size) {
    RoomLayout layout = layout_without(object.id);
    auto place = layout.on_floor(size);
    return place ? place : layout.in_middle(size);
  }
  std::optional<OrientedBox> deck_place(const RoomObject& object, const Eigen::Vector3f& size) {
    std::vector<const RoomObject*> decks;
    for (const RoomObject& other : room_.objects)
      if (other.footprint && other.id != object.id && other.footprint->top_m > kLowestDeck_m &&
          other.footprint->top_m < kHighestDeck_m)
        decks.push_back(&other);
    if (decks.empty()) return std::nullopt;
    const RoomObject& deck = *decks[random_.index(decks.size())];
    RoomLayout layout = layout_without(object.id);
    const auto& pieces = layout.pieces();
    const auto number = std::find_if(pieces.begin(), pieces.end(), [&](const OrientedBox& box) {
      return box.center_m == deck.footprint->center_m && box.top_m == deck.footprint->top_m;
    });
    return layout.on_top(static_cast<std::size_t>(number - pieces.begin()),
                         HeightMap(own_frame(deck)), size, false);
  }

  const SynthRoom& room_;
  const VisitsConfig& config_;
  Random random_;
  std::vector<OrientedBox> kept_;
};

/// Things that come later are away at first: `full` has them.
Visit first_visit(const SynthRoom& full, int visits, const VisitsConfig& config,
                  std::vector<std::uint16_t>& later) {
  Visit visit{full, {}};
  later = Rearranger(visit.room, config, Random(full.seed, kVisitStream).bits()).movable();
  later.resize(std::min(later.size(), static_cast<std::size_t>((visits - 1) * config.added)));
  for (const std::uint16_t id : later) take_away(visit.room.objects[id - 1u]);
  return visit;
}

Visit next_visit(const Visit& before, const SynthRoom& full, std::uint64_t seed,
                 const VisitsConfig& config, std::vector<std::uint16_t>& later) {
  Visit visit{before.room, {}};
  visit.room.seed = seed;
  std::vector<OrientedBox> kept;
  for (const std::uint16_t id : later) kept.push_back(*full.objects[id - 1u].footprint);
  Rearranger rearranger(visit.room, config, seed, std::move(kept));
  int removed = 0, away = 0, added = 0;
  for (const std::uint16_t id : rearranger.movable()) {
    RoomObject& object = visit.room.objects[id - 1u];
    if (removed < config.removed) {
      visit.changes.push_back({RoomChangeKind::kRemoved, id, object.box, {}});
      take_away(object);
      ++removed;
    } else if (away < config.moved) {
      const auto place = rearranger.new_place(object);
      if (!place) continue;
      visit.changes.push_back(moved(object, *place));
      ++away;
    }
  }
  for (; added < config.added && !later.empty(); later.pop_back()) {
    const RoomObject& object = full.objects[later.back() - 1u];
    visit.room.objects[object.id - 1u] = object;
    visit.changes.push_back({RoomChangeKind::kAdded, object.id, {}, object.box});
    ++added;
  }
  int turned = 0;
  for (const std::uint16_t id : rearranger.doors())
    if (turned < config.doors)
      if (const auto place = rearranger.other_angle(visit.room.objects[id - 1u])) {
        visit.changes.push_back(moved(visit.room.objects[id - 1u], *place));
        ++turned;
      }
  std::sort(visit.changes.begin(), visit.changes.end(),
            [](const RoomChange& a, const RoomChange& b) { return a.object < b.object; });
  return visit;
}

}  // namespace

void list_fields(VisitsConfig& config, ConfigFields& fields) {
  fields.add("moved", config.moved, 0, 1000, "things that move between two visits");
  fields.add("removed", config.removed, 0, 1000, "things that are carried off");
  fields.add("added", config.added, 0, 1000, "things that are brought in");
  fields.add("least_height_m", config.least_height_m, 0.f, 10.f, "lower things stay, metres");
  fields.add("least_side_m", config.least_side_m, 0.f, 10.f, "shorter things stay, metres");
  fields.add("largest_footprint_m2", config.largest_footprint_m2, 0.f, 100.f,
             "larger pieces stay, square metres");
  fields.add("tallest_m", config.tallest_m, 0.f, 100.f, "taller pieces stay, metres");
  fields.add("least_way_m", config.least_way_m, 0.f, 10.f,
             "a thing that moves goes at least so far, metres");
  fields.add("doors", config.doors, 0, 1000, "doors between rooms that are opened or pushed to");
  fields.add("least_open_rad", config.least_open_rad, 0.f, 3.f, "so far they stay open, radians");
  fields.add("most_open_rad", config.most_open_rad, 0.f, 3.f, "and no further, radians");
  fields.add("least_turn_rad", config.least_turn_rad, 0.f, 3.f,
             "a door that is turned turns at least so far, radians");
}

std::vector<Visit> plan_visits(const SynthRoom& room, int visits, const VisitsConfig& config) {
  std::vector<std::uint16_t> later;
  std::vector<Visit> all = {first_visit(room, visits, config, later)};
  for (int i = 1; i < visits; ++i) {
    const std::uint64_t seed = Random(room.seed, kVisitStream + static_cast<unsigned>(i)).bits();
    all.push_back(next_visit(all.back(), room, seed, config, later));
  }
  return all;
}

}  // namespace ovimap
