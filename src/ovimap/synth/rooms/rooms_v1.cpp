// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/rooms/rooms_v1.h"

namespace ovimap {
namespace {

using enum Placement;
using Classes = std::vector<std::string>;

constexpr float kRadiator_m = 0.12f, kTowelRack_m = 0.85f, kPaper_m = 0.6f;
constexpr float kWallCabinet_m = 1.45f, kRangeHood_m = 1.55f, kWallTv_m = 1.05f;

RoomSpec furnished(const char* name, const Eigen::Vector3f& size_m) {
  RoomSpec spec;
  spec.name = name;
  spec.size_m = size_m;
  spec.camera = synth_camera(640, 480);
  return spec;
}

RoomSpec living_room() {
  RoomSpec spec = furnished("living-room", {5.8f, 4.8f, 2.6f});
  const Classes low = {"cabinet"}, coffee = {"coffee table"}, stand = {"tv stand"},
                seats = {"sofa"};
  spec.furniture = {{"door", kInWall},
                    {"window", kInWall, 2},
                    {"sofa", kAgainstWall, 1, {}, "BlendSwap-CC-BY/couch3"},
                    {"tv stand", kAgainstWall},
                    {"bookshelf", kAgainstWall, 1, {}, "KatorLegaz/full-bookcase"},
                    {"piano", kAgainstWall},
                    {"cabinet", kAgainstWall, 1, {}, "BlendSwap-CC-0/shelves"},
                    {"armchair", kInCorner, 1, {}, "BlendSwap-CC-BY/fotel"},
                    {"coffee table", kInMiddle, 1, {}, "Scopia/saloon_table"},
                    {"stool", kAround, 2, coffee},
                    {"floor lamp", kInCorner},
                    {"plant", kInCorner, 1, {}, "BlendSwap-CC-0/decorativePlant"},
                    {"tv", kOnTop, 1, stand, "BlendSwap-CC-0/led_tv"},
                    {"speaker", kOnFloor, 2},
                    {"guitar", kOnFloor},
                    {"box", kOnFloor, 1, {}, "BlendSwap-CC-BY/gift"},
                    {"ball", kOnFloor},
                    {"pillow", kOnTop, 2, seats},
                    {"stereo", kOnTop, 1, low},
                    {"vase", kOnTop, 1, low},
                    {"potted plant", kOnTop, 1, low},
                    {"bowl", kOnTop, 1, coffee, "Scopia/bowlWithFruits"},
                    {"book", kOnTop, 2, coffee},
                    {"game controller", kOnTop, 1, coffee},
                    {"mug", kOnTop, 1, coffee},
                    {"radiator", kOnWall, 1, {}, "BlendSwap-CC-BY/modernRadiator", kRadiator_m},
                    {"clock", kOnWall},
                    {"picture", kOnWall, 3},
                    {"rug", kRug},
                    {"ceiling lamp", kOnCeiling, 2}};
  return spec;
}

RoomSpec bedroom() {
  RoomSpec spec = furnished("bedroom", {4.6f, 4.0f, 2.5f});
  spec.floor_style = "carpet";
  spec.accent_style = "dots";
  spec.wall_color = {214, 220, 214};
  spec.accent_color = {206, 190, 188};
  const Classes bed = {"bed"}, bedside = {"nightstand"}, desk = {"desk"}, low = {"cabinet"};
  spec.furniture = {{"door", kInWall},
                    {"window", kInWall},
                    {"bed", kAgainstWall, 1, {}, "BlendSwap-CC-0/bed1"},
                    {"wardrobe", kAgainstWall, 1, {}, "BlendSwap-CC-BY/wardrobe2"},
                    {"desk", kAgainstWall, 1, {}, "BlendSwap-CC-BY/simpleDesk"},
                    {"cabinet", kAgainstWall, 1, {}, "BlendSwap-CC-BY/dresserWithDrawers"},
                    {"nightstand", kAgainstWall, 2, {}, "BlendSwap-CC-0/bedsideTable2"},
                    {"chair", kAround, 1, desk, "BlendSwap-CC-0/plasticChair"},
                    {"laundry basket", kInCorner},
                    {"plant", kInCorner, 1, {}, "Scopia/maceta"},
                    {"suitcase", kOnFloor},
                    {"rocking horse", kOnFloor},
                    {"dollhouse", kOnFloor},
                    {"shoes", kOnFloor, 1, {}, "Scopia/sneakers"},
                    {"bag", kOnFloor, 1, {}, "BlendSwap-CC-0/handbag"},
                    {"blanket", kOnTop, 1, bed},
                    {"pillow", kOnTop, 2, bed},
                    {"teddy bear", kOnTop, 1, {"bed", "cabinet"}, {}, {}},
                    {"lamp", kOnTop, 2, bedside},
                    {"book", kOnTop, 1, bedside},
                    {"laptop", kOnTop, 1, desk},
                    {"headphones", kOnTop, 1, desk},
                    {"photo frame", kOnTop, 2, low},
                    {"clothes", kOnTop, 1, low},
                    {"radiator", kOnWall, 1, {}, "BlendSwap-CC-0/radiator3", kRadiator_m},
                    {"picture", kOnWall, 2},
                    {"rug", kRug},
                    {"ceiling lamp", kOnCeiling}};
  return spec;
}

RoomSpec kitchen() {
  RoomSpec spec = furnished("kitchen", {4.6f, 3.8f, 2.5f});
  spec.floor_style = "tiles";
  spec.wall_color = {230, 226, 214};
  spec.accent_color = {196, 204, 186};
  const Classes counter = {"kitchen cabinet", "sink"}, table = {"table"}, stove = {"stove"};
  spec.furniture = {{"door", kInWall},
                    {"window", kInWall},
                    {"refrigerator", kAgainstWall, 1, {}, "BlendSwap-CC-0/largeFridge"},
                    {"stove", kAgainstWall},
                    {"sink", kAgainstWall, 1, {}, "BlendSwap-CC-BY/kitchenSink"},
                    {"kitchen cabinet", kAgainstWall, 2, {}, "BlendSwap-CC-BY/kitchenLowerCabinet"},
                    {"kitchen cabinet", kAgainstWall, 1, {}, "BlendSwap-CC-0/drawersCabinet"},
                    {"oven", kAgainstWall, 1, {}, "BlendSwap-CC-0/doubleOven"},
                    {"washing machine", kAgainstWall, 1, {}, "Scopia/clothes_washing_machine"},
                    {"table", kInMiddle, 1, {}, "Scopia/wooden_table_office"},
                    {"chair", kAround, 4, table, "BlendSwap-CC-0/osakaChair"},
                    {"trash can", kOnFloor, 1, {}, "KatorLegaz/bullet-trash-can"},
                    {"wall cabinet", kOnWall, 2, {}, "BlendSwap-CC-0/upperCabinet", kWallCabinet_m},
                    {"range hood", kOnWall, 1, {}, {}, kRangeHood_m},
                    {"microwave", kOnTop, 1, counter},
                    {"coffee machine", kOnTop, 1, counter},
                    {"toaster", kOnTop, 1, counter},
                    {"mixer", kOnTop, 1, counter},
                    {"knife block", kOnTop, 1, counter},
                    {"paper towel", kOnTop, 1, counter},
                    {"kitchen scale", kOnTop, 1, counter},
                    {"pot", kOnTop, 1, {"stove", "kitchen cabinet"}, {}, {}},
                    {"kettle", kOnTop, 1, {"stove", "kitchen cabinet"}, {}, {}},
                    {"chopping board", kOnTop, 1, {"table", "kitchen cabinet"}, {}, {}},
                    {"mug", kOnTop, 2, table},
                    {"bowl", kOnTop, 1, table},
                    {"teapot", kOnTop, 1, table},
                    {"bread", kOnTop, 1, table},
                    {"milk carton", kOnTop, 1, table},
                    {"bottle", kOnTop, 1, table},
                    {"picture", kOnWall},
                    {"ceiling lamp", kOnCeiling}};
  return spec;
}

RoomSpec office() {
  RoomSpec spec = furnished("office", {5.4f, 4.4f, 2.7f});
  spec.floor_style = "carpet";
  spec.accent_style = "plaster";
  spec.wall_color = {232, 232, 230};
  spec.accent_color = {176, 196, 208};
  const Classes desk = {"desk"}, table = {"table"}, low = {"cabinet"};
  spec.furniture = {{"door", kInWall},
                    {"window", kInWall, 2},
                    {"desk", kAgainstWall, 2, {}, "BlendSwap-CC-0/lbDesk"},
                    {"office chair", kAround, 2, desk, "Scopia/office_chair"},
                    {"bookshelf", kAgainstWall, 1, {}, "BlendSwap-CC-0/bookcase"},
                    {"cabinet", kAgainstWall, 1, {}, "BlendSwap-CC-0/shelves"},
                    {"filing cabinet", kAgainstWall, 2},
                    {"water cooler", kAgainstWall},
                    {"whiteboard", kAgainstWall},
                    {"table", kInMiddle, 1, {}, "KatorLegaz/folding-table"},
                    {"chair", kAround, 3, table, "Scopia/plastic_chair"},
                    {"plant", kInCorner, 1, {}, "BlendSwap-CC-BY/mediumIndoorPlant"},
                    {"trash can", kOnFloor, 1, {}, "BlendSwap-CC-0/dustbin"},
                    {"box", kOnFloor, 2, {}, "Scopia/cardboard-box"},
                    {"fire extinguisher", kOnFloor},
                    {"backpack", kOnFloor},
                    {"bag", kOnFloor, 1, {}, "BlendSwap-CC-0/briefcase"},
                    {"computer", kOnTop, 2, desk, "Scopia/apple_pc"},
                    {"telephone", kOnTop, 1, desk},
                    {"lamp", kOnTop, 1, desk, "BlendSwap-CC-0/desklamp"},
                    {"pen holder", kOnTop, 1, desk},
                    {"calendar", kOnTop, 1, desk},
                    {"mug", kOnTop, 1, desk},
                    {"letter tray", kOnTop, 1, desk},
                    {"printer", kOnTop, 1, low},
                    {"laptop", kOnTop, 1, table},
                    {"projector", kOnTop, 1, table},
                    {"book", kOnTop, 2, table},
                    {"radiator", kOnWall, 1, {}, "BlendSwap-CC-BY/modernRadiator", kRadiator_m},
                    {"tv", kOnWall, 1, {}, "Scopia/wall-flat-tv", kWallTv_m},
                    {"picture", kOnWall},
                    {"ceiling lamp", kOnCeiling, 2}};
  return spec;
}

RoomSpec bathroom() {
  RoomSpec spec = furnished("bathroom", {3.7f, 3.2f, 2.5f});
  spec.floor_style = "tiles";
  spec.accent_style = "stripes";
  spec.wall_color = {214, 226, 230};
  spec.accent_color = {150, 182, 190};
  const Classes low = {"cabinet", "washing machine"};
  spec.furniture = {{"door", kInWall},
                    {"window", kInWall},
                    {"bathtub", kAgainstWall, 1, {}, "BlendSwap-CC-BY/bath_jay_hardy"},
                    {"shower", kInCorner},
                    {"toilet", kAgainstWall, 1, {}, "BlendSwap-CC-BY/toilets_unit_jay_hardy"},
                    {"washbasin", kAgainstWall},
                    {"washing machine", kAgainstWall, 1, {}, "Scopia/clothes_washing_machine"},
                    {"cabinet", kAgainstWall, 1, {}, "BlendSwap-CC-0/shelves"},
                    {"laundry basket", kInCorner},
                    {"stool", kOnFloor, 1, {}, "BlendSwap-CC-BY/green_stool"},
                    {"trash can", kOnFloor, 1, {}, "BlendSwap-CC-0/dustbin"},
                    {"shoes", kOnFloor, 1, {}, "BlendSwap-CC-0/slippers"},
                    {"radiator", kOnWall, 1, {}, "BlendSwap-CC-0/radiator3", kRadiator_m},
                    {"towel", kOnWall, 1, {}, "BlendSwap-CC-0/towel3", kTowelRack_m},
                    {"towel", kOnWall, 1, {}, "Scopia/com_bath3", kTowelRack_m},
                    {"toilet paper", kOnWall, 1, {}, {}, kPaper_m},
                    {"towel", kOnTop, 1, low, "Scopia/com_bath3_toalla"},
                    {"soap dispenser", kOnTop, 1, low},
                    {"potted plant", kOnTop, 1, low},
                    {"candle", kOnTop, 1, low},
                    {"clothes", kOnTop, 1, low},
                    {"stereo", kOnTop, 1, low, "BlendSwap-CC-BY/radio"},
                    {"toy", kOnFloor},
                    {"ball", kOnFloor},
                    {"box", kOnFloor, 1, {}, "BlendSwap-CC-BY/gift"},
                    {"picture", kOnWall},
                    {"rug", kRug},
                    {"ceiling lamp", kOnCeiling}};
  return spec;
}

}  // namespace

PinholeCamera synth_camera(int width, int height) {
  const float focal_px = 0.75f * static_cast<float>(width);
  return {width,
          height,
          focal_px,
          focal_px,
          0.5f * static_cast<float>(width - 1),
          0.5f * static_cast<float>(height - 1)};
}

std::vector<RoomSpec> rooms_v1() {
  return {living_room(), bedroom(), kitchen(), office(), bathroom()};
}

}  // namespace ovimap
