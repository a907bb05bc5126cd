// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/rooms/room_spec.h"

#include "ovimap/base/config.h"
#include "ovimap/base/error.h"
#include "ovimap/synth/rooms/rooms_v1.h"

namespace ovimap {
namespace {

RoomSpec bare_spec() {
  RoomSpec spec;
  spec.name = "bare";
  spec.size_m = {3.6f, 3.1f, 2.5f};
  spec.frames = 40;
  spec.camera = synth_camera(320, 240);
  return spec;
}

RoomSpec tiny_spec() {
  RoomSpec spec = bare_spec();
  spec.name = "tiny";
  using enum Placement;
  const std::vector<std::string> tables = {"table"}, low = {"cabinet"};
  spec.furniture = {{"door", kInWall},
                    {"window", kInWall},
                    {"sofa", kAgainstWall, 1, {}, "BlendSwap-CC-0/sofa2"},
                    {"bookshelf", kAgainstWall, 1, {}, "KatorLegaz/full-bookcase"},
                    {"cabinet", kAgainstWall, 1, {}, "BlendSwap-CC-0/shelves"},
                    {"table", kInMiddle, 1, {}, "Scopia/white_kitchen_table"},
                    {"chair", kAround, 2, tables, "BlendSwap-CC-BY/plaidChair"},
                    {"plant", kInCorner, 1, {}, "BlendSwap-CC-0/decorativePlant"},
                    {"trash can", kOnFloor},
                    {"lamp", kOnTop, 1, low, "Scopia/little_lamp1"},
                    {"laptop", kOnTop, 1, tables},
                    {"mug", kOnTop, 1, tables, "Scopia/cup"},
                    {"book", kOnTop, 1, tables},
                    {"bowl", kOnTop, 1, tables, "Scopia/bowlWithFruits"},
                    {"picture", kOnWall},
                    {"rug", kRug},
                    {"ceiling lamp", kOnCeiling}};
  return spec;
}

}  // namespace

std::vector<std::string> room_names() {
  std::vector<std::string> names = {"bare", "tiny"};
  for (const std::string& name : rooms_v1_names()) names.push_back(name);
  return names;
}

std::vector<std::string> rooms_v1_names() {
  std::vector<std::string> names;
  for (const RoomSpec& spec : rooms_v1()) names.push_back(spec.name);
  return names;
}

RoomSpec room_spec(const std::string& name, std::uint64_t seed) {
  std::vector<RoomSpec> specs = rooms_v1();
  specs.push_back(bare_spec());
  specs.push_back(tiny_spec());
  for (RoomSpec& spec : specs)
    if (spec.name == name) {
      spec.seed = seed;
      return spec;
    }
  throw Error(concat("room '", name, "': no such room, did you mean '",
                     nearest_word(name, room_names()), "'?"));
}

}  // namespace ovimap
