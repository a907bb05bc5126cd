// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/buildings/flat_rooms.h"

#include "ovimap/base/error.h"
#include "ovimap/synth/buildings/made_requests.h"

namespace ovimap {
namespace {

using enum Placement;

constexpr float kFlatHeight_m = 2.55f, kRadiatorBottom_m = 0.12f, kWallCabinetBottom_m = 1.45f,
                kShelfBottom_m = 1.35f;

/// Models of the furniture library: those of one split are in no room of the other, and no unseen
/// one is in a room that parameters are tuned on, of any benchmark.
FurnitureRequest from_library(Split split, const char* class_name, const char* tuned,
                              const char* unseen, Placement placement) {
  return {class_name, placement, 1, {}, split == Split::kTuned ? tuned : unseen, {}};
}

const Names kReading =
    all_made({"book", "magazine", "paper", "phone", "glasses", "remote control"});

void living_room(RoomSpec& spec) {
  const Names low = {"coffee table"}, stand = {"tv stand"}, seats = {"sofa", "armchair"};
  spec.furniture = {
      made("window", kInWall, 2),
      made("sofa", kAgainstWall),
      made("tv stand", kAgainstWall),
      made("bookshelf", kAgainstWall),
      made("coffee table", kInMiddle),
      made("armchair", kInCorner),
      made("cabinet", kAgainstWall),
      made("tv", kOnTop, 1, stand),
      made("floor lamp", kInCorner),
      made("plant", kInCorner),
      made("stool", "pouf", kOnFloor),
      from_library(spec.split, "guitar", "BlendSwap-CC-0/electricGuitar", "made:barbell", kOnFloor),
      made("pillow", "cushion", kOnTop, 4, seats),
      made("blanket", "folded blanket", kOnTop, 1, seats),
      made("lamp", "table lamp", kOnTop, 1, {"cabinet"}),
      made("picture", "leaning picture", kAgainstWall),
      made("curtain", kOnWall, 2, {}, 0.03f),
      made("radiator", kOnWall, 1, {}, kRadiatorBottom_m),
      made("shelf", "wall shelf", kOnWall, 1, {}, kShelfBottom_m),
      made("picture", kOnWall, 4),
      made("rug", kRug),
      made("ceiling lamp", kOnCeiling, 2)};
  spec.clutter = {
      {low,
       all_made({"book", "magazine", "mug", "bowl", "remote control", "phone", "tray", "glass",
                 "game pad"}),
       4, 7},
      {{"cabinet", "tv stand"},
       all_made({"photo stand", "vase", "potted plant", "book", "remote control", "keys", "bowl"}),
       3,
       6},
      {{"bookshelf", "shelf"}, all_made({"standing book"}), 3, 9},
      {{"bookshelf", "shelf"},
       all_made({"photo stand", "vase", "box", "book", "potted plant"}),
       0,
       2},
      {{"sofa"}, kReading, 0, 2}};
}

void kitchen(RoomSpec& spec) {
  const Names counter = {"kitchen cabinet"};
  spec.furniture = {made("window", kInWall),
                    made("refrigerator", kAgainstWall),
                    made("stove", kAgainstWall),
                    made("kitchen cabinet", "kitchen counter", kAgainstWall, 2),
                    made("table", kInMiddle),
                    made("chair", kAround, 4, {"table"}),
                    made("wall cabinet", kOnWall, 2, {}, kWallCabinetBottom_m),
                    from_library(spec.split, "trash can", "KatorLegaz/bullet-trash-can",
                                 "BlendSwap-CC-0/dustbin", kOnFloor),
                    made("shelf", "wall shelf", kOnWall, 1, {}, kShelfBottom_m),
                    made("picture", kOnWall, 2),
                    made("radiator", kOnWall, 1, {}, kRadiatorBottom_m),
                    made("ceiling lamp", kOnCeiling)};
  const Names dishes = {"mug", "plate", "bowl", "glass", "bottle", "cutlery"};
  spec.clutter = {{counter,
                   all_made({"kettle", "pot", "bottle", "can", "carton", "bowl", "plate", "mug",
                             "cutlery", "tissue box"}),
                   5, 8},
                  {{"table"}, all_made(dishes), 5, 8},
                  {{"table"}, all_made({"place mat", "magazine", "envelope", "keys"}), 1, 3},
                  {{"stove"}, all_made({"pot", "kettle"}), 1, 2},
                  {{"refrigerator"}, all_made({"carton", "basket", "box"}), 1, 2},
                  {{"shelf"}, all_made({"can", "carton", "mug", "glass", "bottle"}), 4, 7}};
}

void bedroom(RoomSpec& spec) {
  spec.furniture = {made("window", kInWall),
                    made("bed", kAgainstWall),
                    made("wardrobe", kAgainstWall),
                    made("nightstand", kAgainstWall, 2),
                    made("cabinet", kAgainstWall),
                    made("laundry basket", "basket", kInCorner),
                    made("chair", kOnFloor),
                    made("pillow", "cushion", kOnTop, 2, {"bed"}),
                    made("blanket", "folded blanket", kOnTop, 1, {"bed", "chair"}),
                    made("lamp", "table lamp", kOnTop, 2, {"nightstand"}),
                    made("shoes", kOnFloor, 2),
                    made("box", kOnFloor),
                    from_library(spec.split, "suitcase", "BlendSwap-CC-BY/suitcase",
                                 "Scopia/cardboard-box", kOnFloor),
                    made("curtain", kOnWall, 2, {}, 0.03f),
                    made("radiator", kOnWall, 1, {}, kRadiatorBottom_m),
                    made("picture", kOnWall, 3),
                    made("rug", kRug),
                    made("ceiling lamp", kOnCeiling)};
  spec.clutter = {
      {{"nightstand"},
       all_made({"book", "phone", "glasses", "mug", "tissue box", "charger"}),
       2,
       4},
      {{"cabinet"},
       all_made({"photo stand", "vase", "bottle", "box", "book", "potted plant", "keys"}),
       4,
       7},
      {{"bed"}, kReading, 0, 2}};
}

void study(RoomSpec& spec) {
  const Names desk = {"desk"};
  spec.furniture = {made("window", kInWall),
                    made("desk", kAgainstWall),
                    made("bookshelf", kAgainstWall, 2),
                    made("chair", kAround, 1, desk),
                    made("cabinet", kAgainstWall),
                    made("armchair", kInCorner),
                    made("monitor", kOnTop, 1, desk),
                    made("lamp", "desk lamp", kOnTop, 1, desk),
                    made("barbell", kOnFloor),
                    from_library(spec.split, "backpack", "BlendSwap-CC-0/handbag",
                                 "BlendSwap-CC-BY/backpack", kOnFloor),
                    made("picture", "leaning picture", kAgainstWall),
                    made("box", kOnFloor, 2),
                    made("plant", kInCorner),
                    made("radiator", kOnWall, 1, {}, kRadiatorBottom_m),
                    made("picture", kOnWall, 2),
                    made("rug", kRug),
                    made("ceiling lamp", kOnCeiling)};
  spec.clutter = {
      {desk, all_made({"keyboard"}), 1, 1},
      {desk, all_made({"mouse"}), 1, 1},
      {desk, all_made({"paper", "book", "pen", "mug", "phone", "notebook", "cable", "calculator"}),
       6, 9},
      {{"bookshelf"}, all_made({"standing book"}), 3, 10},
      {{"bookshelf", "cabinet"},
       all_made({"box", "folder", "photo stand", "potted plant", "book"}),
       0,
       3}};
}

void child_room(RoomSpec& spec) {
  spec.furniture = {
      made("window", kInWall),
      made("bed", kAgainstWall),
      made("bookshelf", kAgainstWall),
      made("desk", kAgainstWall),
      made("stool", kAround, 1, {"desk"}),
      made("cabinet", kAgainstWall),
      made("stool", "pouf", kOnFloor),
      from_library(spec.split, "teddy bear", "BlendSwap-CC-0/teddyBear", "made:box", kOnFloor),
      from_library(spec.split, "ball", "BlendSwap-CC-0/basketball", "made:basket", kOnFloor),
      made("pillow", "cushion", kOnTop, 3, {"bed"}),
      made("lamp", "table lamp", kOnTop, 1, {"desk"}),
      made("curtain", kOnWall, 1, {}, 0.03f),
      made("picture", kOnWall, 4),
      made("rug", kRug),
      made("ceiling lamp", kOnCeiling)};
  spec.clutter = {
      {{"desk"},
       all_made({"pen", "paper", "notebook", "scissors", "tape", "book", "ruler", "pen holder"}),
       6,
       9},
      {{"bookshelf"}, all_made({"standing book"}), 2, 8},
      {{"bookshelf"}, all_made({"box", "book", "game pad", "carton"}), 0, 2},
      {{"cabinet"}, all_made({"box", "tablet", "headphones", "book", "game pad"}), 2, 4}};
}

void hall(RoomSpec& spec) {
  spec.furniture = {made("cabinet", kAgainstWall),
                    made("stool", kOnFloor),
                    made("shoes", kOnFloor, 3),
                    made("plant", kInCorner),
                    made("picture", kOnWall, 4),
                    made("shelf", "wall shelf", kOnWall, 1, {}, kShelfBottom_m),
                    made("ceiling lamp", kOnCeiling, 2)};
  spec.clutter = {
      {{"cabinet"},
       all_made({"keys", "envelope", "bowl", "photo stand", "glasses", "phone", "vase"}),
       4,
       6},
      {{"shelf"}, all_made({"box", "book", "basket", "vase"}), 1, 3}};
}

/// Floors, walls and light of the two halves.
void decorate(RoomSpec& spec, const std::string& kind) {
  const bool tuned = spec.split == Split::kTuned, wet = kind == "kitchen";
  spec.floor_style = tuned ? (wet                 ? "tiles"
                              : kind == "bedroom" ? "pine"
                                                  : "oak")
                           : (wet                 ? "mosaic"
                              : kind == "bedroom" ? "ash"
                                                  : "parquet");
  spec.wall_style = tuned ? "plaster" : "roller";
  spec.accent_style = tuned ? "stripes" : "panels";
  spec.wall_color = tuned ? Rgb8{232, 230, 224} : Rgb8{238, 238, 236};
  spec.accent_color = tuned ? Rgb8{214, 212, 202} : Rgb8{204, 212, 208};
}

}  // namespace

RoomSpec flat_room(const std::string& kind, Split split, const Eigen::Vector2f& floor_m) {
  RoomSpec spec;
  spec.name = kind;
  spec.split = split;
  spec.size_m = {floor_m.x(), floor_m.y(), kFlatHeight_m};
  decorate(spec, kind);
  if (kind == "living-room")
    living_room(spec);
  else if (kind == "kitchen")
    kitchen(spec);
  else if (kind == "bedroom")
    bedroom(spec);
  else if (kind == "study")
    study(spec);
  else if (kind == "child-room")
    child_room(spec);
  else if (kind == "hall")
    hall(spec);
  else
    throw Error(
        "room '" + kind +
        "': no flat has one; living-room, kitchen, bedroom, study, child-room and hall are known");
  return spec;
}

}  // namespace ovimap
