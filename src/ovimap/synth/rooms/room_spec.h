// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "ovimap/geometry/camera.h"
#include "ovimap/image/image.h"
#include "ovimap/synth/procedural/made_model.h"

namespace ovimap {

/// Where a piece of furniture goes.
enum class Placement {
  kInWall,       ///< flat on a wall, kept clear in front: doors, windows
  kAgainstWall,  ///< back to a wall, front facing inwards
  kInCorner,
  kInMiddle,
  kAround,   ///< at the sides of pieces of the named classes, facing them: chairs at a table
  kOnTop,    ///< on pieces of the named classes
  kOnFloor,  ///< anywhere free, near the walls
  kOnWall,   ///< hung on a wall: pictures
  kOnCeiling,
  kRug,  ///< flat on the floor; furniture may stand on it
};

struct FurnitureRequest {
  std::string class_name;  ///< one of the palette's classes
  Placement placement = Placement::kAgainstWall;
  int count = 1;
  std::vector<std::string> at = {};    ///< for kAround and kOnTop: classes of the supporting pieces
  std::string model = {};              ///< a catalogue id, or made_id of a kind that is made by
                                       ///< rule; empty: any model of the class
  std::optional<float> bottom_m = {};  ///< for kOnWall: its lower edge; else centred at eye height
};

/// Catalogue ids of models, by class.
using ModelChoice = std::map<std::string, std::vector<std::string>>;

/// An opening in a wall that one walks through.
struct Doorway {
  std::size_t wall = 0;  ///< number of the wall in wall_lines
  float center_m = 0;    ///< along the wall, from its start
  float width_m = 0.9f, height_m = 2.05f;
};

/// Names a kind of made_kinds where a model is asked for.
inline std::string made_id(const std::string& kind) {
  return "made:" + kind;
}

/// Things that lie about on the decks of pieces.
struct Clutter {
  std::vector<std::string> at;      ///< classes of the pieces that they lie on
  std::vector<std::string> models;  ///< one of these each: made_id or a catalogue id
  int least = 1, most = 3;          ///< on each deck
};

/// How a room is lit, as factors on ordinary lamps, daylight and light from everywhere.
struct RoomLight {
  float lamps = 1, windows = 1, ambient = 1;
  Eigen::Vector3f tint = Eigen::Vector3f::Ones();  ///< of lamps and ambient light
};

/// What a room is made from. The same spec gives the same room.
struct RoomSpec {
  std::string name;
  std::uint64_t seed = 1;
  Eigen::Vector3f size_m = {4, 4, 2.5f};  ///< width (x), depth (y), height
  std::string floor_style = "oak";
  std::string wall_style = "plaster";
  std::string accent_style = "stripes";  ///< of one wall
  Rgb8 wall_color = {226, 220, 206};
  Rgb8 accent_color = {196, 206, 212};
  std::vector<FurnitureRequest> furniture;  ///< in the order of placing: large before small
  std::vector<Doorway> doorways = {};
  std::array<bool, 4> may_have_windows = {true, true, true, true};  ///< by wall
  Split split = Split::kTuned;  ///< which things the made ones are
  /// Catalogue ids by class, to be drawn from instead of models_of_class: pieces of other classes
  /// are left out. Empty: as the palette says.
  ModelChoice models = {};
  std::vector<Clutter> clutter = {};
  RoomLight light = {};
  int frames = 200;
  PinholeCamera camera;
};

/// The rooms that can be made by name: "tiny" (3.6 x 3.1 m, 40 frames of 320x240), "bare" (the
/// same without furniture, which needs no furniture package), and the rooms of rooms-v1. Throws
/// Error for another name.
RoomSpec room_spec(const std::string& name, std::uint64_t seed = 1);
std::vector<std::string> room_names();

/// The benchmark's rooms: 25 or more objects, 200 frames of 640x480 each.
inline constexpr const char* kRoomsV1 = "rooms-v1";
std::vector<std::string> rooms_v1_names();

}  // namespace ovimap
