// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/buildings/room_builder.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "ovimap/synth/buildings/strewn.h"
#include "ovimap/synth/furniture/furniture_palette.h"
#include "ovimap/synth/furniture/model_store.h"
#include "ovimap/synth/rooms/room_shell.h"
#include "ovimap/synth/shapes/mesh_parts.h"

namespace ovimap {
namespace {

constexpr int kLayouts = 60;
constexpr float kInWallDepth_m = 0.07f;  // what is seen of doors and windows
constexpr float kWindowSill_m = 0.85f;
constexpr float kWindowClear_m = 0.35f;  // no tall furniture nearer to a window
constexpr float kPictureCenter_m = 1.55f;
constexpr float kLampGlow = 2.f;
constexpr float kLampHalf_m = 0.25f;  // of the shining square below a ceiling lamp
constexpr float kLightGap_m = 0.02f;
const Eigen::Vector3f kLampLight(0.30f, 0.285f, 0.26f);  // per square metre of floor
const Eigen::Vector3f kWindowLight(1.5f, 1.6f, 1.7f);    // per square metre of window
const Eigen::Vector3f kShadeLight(1.5f, 1.2f, 0.8f);
constexpr float kShadeHalf_m = 0.08f, kShadeShare = 0.78f;
const Eigen::Vector3f kAmbient(0.46f, 0.46f, 0.47f);

enum BuildStream : std::uint64_t { kModelStream = 1, kOutdoorStream = 2, kLayoutStream = 1000 };

/// One thing to place.
struct Piece {
  const FurnitureRequest* request = nullptr;
  std::shared_ptr<const RoomModel> model;
};

/// Where the pieces of one try went; pieces without a place have none.
struct Arrangement {
  std::vector<std::optional<OrientedBox>> boxes;
  std::size_t missing = 0;
};

class Arranger {
 public:
  Arranger(const RoomSpec& spec, const std::vector<Piece>& pieces, const LayoutConfig& config,
           std::uint64_t seed)
      : spec_(spec), pieces_(pieces), config_(config), layout_(spec.size_m, seed, config) {}

  Arrangement arrange() {
    Arrangement result;
    for (const Doorway& doorway : spec_.doorways) {
      const OrientedBox box = doorway_box(spec_, doorway, kInWallDepth_m);
      layout_.add(box);
      layout_.keep_clear(RoomLayout::space_in_front(box, config_.door_clearance_m));
    }
    for (const Piece& piece : pieces_) {
      auto box = place(piece);
      if (box && piece.request->placement != Placement::kRug) {
        placed_.push_back({layout_.add(*box), &piece});
        keep_clear(*piece.request, *box);
      }
      result.missing += box ? 0 : 1;
      result.boxes.push_back(std::move(box));
    }
    return result;
  }

 private:
  struct Placed {
    std::size_t number;
    const Piece* piece;
  };

  std::optional<OrientedBox> place(const Piece& piece) {
    const Eigen::Vector3f& size = piece.model->size_m;
    switch (piece.request->placement) {
      case Placement::kInWall: {
        const bool door = piece.request->class_name == "door";
        return layout_.on_wall({size.x(), kInWallDepth_m, size.z()}, door ? 0 : kWindowSill_m,
                               door ? std::array{true, true, true, true} : spec_.may_have_windows);
      }
      case Placement::kAgainstWall:
        return layout_.against_wall(size);
      case Placement::kInCorner:
        return layout_.in_corner(size);
      case Placement::kInMiddle:
        return layout_.in_middle(size);
      case Placement::kOnFloor:
        return layout_.on_floor(size);
      case Placement::kOnWall:
        return layout_.on_wall(size,
                               piece.request->bottom_m.value_or(kPictureCenter_m - size.z() / 2));
      case Placement::kOnCeiling:
        return on_ceiling(piece);
      case Placement::kRug:
        return rug(size);
      case Placement::kAround:
      case Placement::kOnTop:
        return at_support(piece);
    }
    return std::nullopt;
  }

  std::optional<OrientedBox> at_support(const Piece& piece) {
    std::vector<Placed> supports;
    for (const Placed& placed : placed_) {
      const auto& at = piece.request->at;
      if (std::find(at.begin(), at.end(), placed.piece->request->class_name) != at.end())
        supports.push_back(placed);
    }
    layout_.random().shuffle(supports);
    for (const Placed& support : supports) {
      const bool against_wall = support.piece->request->placement == Placement::kAgainstWall;
      auto box = piece.request->placement == Placement::kAround
                     ? layout_.around(layout_.pieces()[support.number], piece.model->size_m)
                     : layout_.on_top(support.number, support.piece->model->upper_side,
                                      piece.model->size_m, against_wall, piece.model->soft);
      if (box) return box;
    }
    return std::nullopt;
  }

  /// Lamps of one request hang in a row along the longer side of the room.
  OrientedBox on_ceiling(const Piece& piece) {
    const Eigen::Vector3f& size = piece.model->size_m;
    const int along = spec_.size_m.x() >= spec_.size_m.y() ? 0 : 1;
    Eigen::Vector2f center = spec_.size_m.head<2>() / 2;
    center[along] = spec_.size_m[along] * (static_cast<float>(lamps_++) + 0.5f) /
                    static_cast<float>(piece.request->count);
    return {center, size.head<2>() / 2, 0, spec_.size_m.z() - size.z(), spec_.size_m.z()};
  }

  OrientedBox rug(const Eigen::Vector3f& size) const {
    Eigen::Vector2f center = spec_.size_m.head<2>() / 2;
    for (const Placed& placed : placed_)
      if (placed.piece->request->placement == Placement::kInMiddle)
        center = layout_.pieces()[placed.number].center_m;
    const Eigen::Vector2f half = size.head<2>() / 2,
                          margin = half + Eigen::Vector2f::Constant(0.05f);
    center = center.cwiseMax(margin).cwiseMin(spec_.size_m.head<2>() - margin);
    return {center, half, 0, 0, size.z()};
  }

  void keep_clear(const FurnitureRequest& request, const OrientedBox& box) {
    if (request.placement == Placement::kAgainstWall)
      layout_.keep_clear(RoomLayout::space_in_front(box, config_.front_clearance_m));
    if (request.placement == Placement::kInWall)
      layout_.keep_clear(RoomLayout::space_in_front(
          box, request.class_name == "door" ? config_.door_clearance_m : kWindowClear_m));
  }

  const RoomSpec& spec_;
  const std::vector<Piece>& pieces_;
  const LayoutConfig& config_;
  RoomLayout layout_;
  std::vector<Placed> placed_;
  int lamps_ = 0;
};

bool made_by_rule(const FurnitureRequest& request) {
  return request.model.starts_with(made_id("")) || models_of_class(request.class_name).empty();
}

/// The id of the model to draw, empty for any of the class; nothing where a choice has none.
std::optional<std::string> chosen_model(const FurnitureRequest& request, const ModelChoice& choice,
                                        Random& random) {
  if (choice.empty() || made_by_rule(request)) return request.model;
  const auto found = choice.find(request.class_name);
  if (found == choice.end()) return std::nullopt;
  return found->second[random.index(found->second.size())];
}

std::vector<Piece> pick_models(const RoomSpec& spec, ModelStore& store) {
  Random random(spec.seed, kModelStream);
  std::vector<Piece> pieces;
  for (const FurnitureRequest& request : spec.furniture) {
    // Alike: chairs at one table, the lamps of one ceiling.
    const bool alike =
        request.placement == Placement::kAround || request.placement == Placement::kOnCeiling;
    std::shared_ptr<const RoomModel> model;
    for (int i = 0; i < request.count; ++i) {
      if (!model || !alike) {
        const auto id = chosen_model(request, spec.models, random);
        if (!id) break;
        model = store.get(request.class_name, *id, spec.size_m, random);
      }
      pieces.push_back({&request, model});
    }
  }
  return pieces;
}

AreaLight lamp_light(const OrientedBox& box, float floor_area_m2, const RoomLight& light) {
  const Eigen::Vector3f center(box.center_m.x(), box.center_m.y(), box.bottom_m - kLightGap_m);
  return {center,
          {kLampHalf_m, 0, 0},
          {0, kLampHalf_m, 0},
          -Eigen::Vector3f::UnitZ(),
          (kLampLight * floor_area_m2 * light.lamps).cwiseProduct(light.tint)};
}

AreaLight window_light(const OrientedBox& box, const RoomLight& light) {
  const Eigen::Vector2f front = box.world_from_box({0, -box.half_m.y() - kLightGap_m});
  const Eigen::Vector2f x = box.x_axis() * box.half_m.x(), inward = -box.y_axis();
  const float half_height = (box.top_m - box.bottom_m) / 2;
  return {{front.x(), front.y(), box.bottom_m + half_height},
          {x.x(), x.y(), 0},
          {0, 0, half_height},
          {inward.x(), inward.y(), 0},
          kWindowLight * (4 * box.half_m.x() * half_height) * light.windows};
}

/// A lamp that stands somewhere: light from its shade downwards.
AreaLight shade_light(const OrientedBox& box, float glow, const RoomLight& light) {
  const float height = box.bottom_m + kShadeShare * (box.top_m - box.bottom_m);
  return {{box.center_m.x(), box.center_m.y(), height},
          {kShadeHalf_m, 0, 0},
          {0, kShadeHalf_m, 0},
          -Eigen::Vector3f::UnitZ(),
          kShadeLight * glow * light.lamps};
}

TexturedMesh piece_mesh(const Piece& piece, const OrientedBox& box, std::uint64_t seed) {
  TexturedMesh mesh = placed_mesh(piece.model->mesh, box);
  if (piece.model->made) return mesh;
  if (piece.request->class_name == "ceiling lamp")
    for (SurfaceMaterial& material : mesh.materials) material.emission.setConstant(kLampGlow);
  if (piece.request->class_name == "window") {
    OrientedBox behind = box;  // the window's back, which lies on the wall
    behind.center_m = box.world_from_box({0, box.half_m.y() * 0.98f});
    behind.half_m.y() = 0;
    const Eigen::Vector3f size(2 * box.half_m.x(), 0, box.top_m - box.bottom_m);
    add_mesh(mesh, placed_mesh(outdoor_model(size, Random(seed, kOutdoorStream).bits()), behind));
  }
  return mesh;
}

void add_piece(const Piece& piece, const OrientedBox& box, std::size_t lamps,
               const RoomLight& light, SynthRoom& room) {
  RoomObject object;
  object.name = piece.model->name;
  object.class_name = piece.model->made ? piece.model->class_name : piece.request->class_name;
  object.source = piece.model->source;
  object.mesh = piece_mesh(piece, box, room.seed);
  object.box = bounds(object.mesh);
  object.footprint = box;
  room.objects.push_back(std::move(object));
  const float floor_area_m2 = room.size_m.x() * room.size_m.y();
  if (piece.request->class_name == "ceiling lamp")
    room.lights.push_back(lamp_light(box, floor_area_m2 / static_cast<float>(lamps), light));
  if (piece.request->class_name == "window") room.lights.push_back(window_light(box, light));
  if (piece.model->glow > 0) room.lights.push_back(shade_light(box, piece.model->glow, light));
}

/// What lies about on the pieces that found a place.
void add_clutter(const RoomSpec& spec, const std::vector<Piece>& pieces,
                 const Arrangement& arrangement, ModelStore& store, SynthRoom& room) {
  std::vector<Carrier> carriers;
  std::vector<OrientedBox> taken;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (!arrangement.boxes[i] || pieces[i].request->placement == Placement::kRug) continue;
    taken.push_back(*arrangement.boxes[i]);
    carriers.push_back({pieces[i].request->class_name, *arrangement.boxes[i], pieces[i].model});
  }
  for (Strewn& thing : strewn(spec, carriers, taken, store)) {
    RoomObject object;
    object.name = thing.model->name;
    object.class_name = thing.class_name;
    object.source = thing.model->source;
    object.mesh = placed_mesh(thing.model->mesh, thing.box);
    object.box = bounds(object.mesh);
    object.footprint = thing.box;
    room.objects.push_back(std::move(object));
  }
}

}  // namespace

OrientedBox doorway_box(const RoomSpec& spec, const Doorway& doorway, float depth_m) {
  const WallLine wall = wall_lines(spec.size_m.head<2>())[doorway.wall];
  const Eigen::Vector2f center =
      wall.start_m + doorway.center_m * wall.along + depth_m / 2 * wall.inward;
  return {center,
          {doorway.width_m / 2, std::abs(depth_m) / 2},
          yaw_facing(wall.inward),
          0,
          doorway.height_m};
}

SynthRoom build_room(const RoomSpec& spec, const std::filesystem::path& furniture_folder,
                     const LayoutConfig& config) {
  ModelStore store(furniture_folder, spec.split);
  const std::vector<Piece> pieces = pick_models(spec, store);
  Arrangement best;
  for (int i = 0; i < kLayouts && (i == 0 || best.missing > 0); ++i) {
    const std::uint64_t seed =
        Random(spec.seed, kLayoutStream + static_cast<std::uint64_t>(i)).bits();
    Arrangement arrangement = Arranger(spec, pieces, config, seed).arrange();
    if (i == 0 || arrangement.missing < best.missing) best = std::move(arrangement);
  }

  SynthRoom room;
  room.name = spec.name;
  room.seed = spec.seed;
  room.size_m = spec.size_m;
  room.ambient = (kAmbient * spec.light.ambient).cwiseProduct(spec.light.tint);
  room.objects = room_shell(spec);
  const auto lamps =
      static_cast<std::size_t>(std::count_if(pieces.begin(), pieces.end(), [](const Piece& piece) {
        return piece.request->class_name == "ceiling lamp";
      }));
  for (std::size_t i = 0; i < pieces.size(); ++i)
    if (best.boxes[i]) add_piece(pieces[i], *best.boxes[i], lamps, spec.light, room);
  if (!spec.clutter.empty()) add_clutter(spec, pieces, best, store, room);
  if (room.lights.empty()) {
    OrientedBox middle;
    middle.center_m = spec.size_m.head<2>() / 2;
    middle.bottom_m = spec.size_m.z();
    room.lights.push_back(lamp_light(middle, spec.size_m.x() * spec.size_m.y(), spec.light));
  }
  for (std::size_t i = 0; i < room.objects.size(); ++i)
    room.objects[i].id = static_cast<std::uint16_t>(i + 1);
  return room;
}

}  // namespace ovimap
