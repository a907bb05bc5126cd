// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/room_spec.h"

#include "ovimap/base/config.h"
#include "ovimap/base/error.h"

namespace ovimap {
namespace {

/// A camera of 67 degrees across, as depth cameras have.
PinholeCamera depth_camera(int width, int height) {
  const float focal_px = 0.75f * static_cast<float>(width);
  return {width,
          height,
          focal_px,
          focal_px,
          0.5f * static_cast<float>(width - 1),
          0.5f * static_cast<float>(height - 1)};
}

RoomSpec bare_spec() {
  RoomSpec spec;
  spec.size_m = {3.6f, 3.1f, 2.5f};
  spec.frames = 40;
  spec.camera = depth_camera(320, 240);
  return spec;
}

RoomSpec tiny_spec() {
  RoomSpec spec = bare_spec();
  using enum Placement;
  const std::vector<std::string> tables = {"table"}, low = {"cabinet"};
  spec.furniture = {{"door", kInWall, 1, {}, ""},
                    {"window", kInWall, 1, {}, ""},
                    {"sofa", kAgainstWall, 1, {}, "BlendSwap-CC-0/sofa2"},
                    {"bookshelf", kAgainstWall, 1, {}, "KatorLegaz/full-bookcase"},
                    {"cabinet", kAgainstWall, 1, {}, "BlendSwap-CC-0/shelves"},
                    {"table", kInMiddle, 1, {}, "Scopia/white_kitchen_table"},
                    {"chair", kAround, 2, tables, "BlendSwap-CC-BY/plaidChair"},
                    {"plant", kInCorner, 1, {}, "BlendSwap-CC-0/decorativePlant"},
                    {"trash can", kOnFloor, 1, {}, ""},
                    {"lamp", kOnTop, 1, low, "Scopia/little_lamp1"},
                    {"laptop", kOnTop, 1, tables, ""},
                    {"mug", kOnTop, 1, tables, "Scopia/cup"},
                    {"book", kOnTop, 1, tables, ""},
                    {"bowl", kOnTop, 1, tables, "Scopia/bowlWithFruits"},
                    {"picture", kOnWall, 1, {}, ""},
                    {"rug", kRug, 1, {}, ""},
                    {"ceiling lamp", kOnCeiling, 1, {}, ""}};
  return spec;
}

}  // namespace

std::vector<std::string> room_names() {
  return {"bare", "tiny"};
}

RoomSpec room_spec(const std::string& name, std::uint64_t seed) {
  RoomSpec spec;
  if (name == "bare") {
    spec = bare_spec();
  } else if (name == "tiny") {
    spec = tiny_spec();
  } else {
    throw Error(concat("room '", name, "': no such room, did you mean '",
                       nearest_word(name, room_names()), "'?"));
  }
  spec.name = name;
  spec.seed = seed;
  return spec;
}

}  // namespace ovimap
