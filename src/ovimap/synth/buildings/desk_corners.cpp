// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/buildings/desk_corners.h"

#include <algorithm>
#include <cmath>

#include "ovimap/base/error.h"
#include "ovimap/synth/buildings/made_requests.h"
#include "ovimap/synth/shapes/angles.h"

namespace ovimap {
namespace {

using enum Placement;

constexpr int kMoments = 32;
constexpr float kNearest_m = 0.3f, kFarther_m = 0.3f;  // from the front edge
constexpr float kShelfFarther_m = 0.55f;               // the more before what stands upright

RoomSpec corner(const char* name, Split split, const RoomLight& light) {
  const bool tuned = split == Split::kTuned;
  RoomSpec spec;
  spec.name = name;
  spec.split = split;
  spec.size_m = {3.2f, 2.8f, 2.5f};
  spec.floor_style = tuned ? "oak" : "parquet";
  spec.wall_style = tuned ? "plaster" : "roller";
  spec.accent_style = tuned ? "stripes" : "panels";
  spec.wall_color = tuned ? Rgb8{230, 226, 218} : Rgb8{236, 237, 238};
  spec.accent_color = tuned ? Rgb8{210, 200, 190} : Rgb8{200, 206, 214};
  spec.light = light;
  return spec;
}

DeskCorner writing_desk(RoomSpec spec) {
  const Names desk = {"desk"};
  spec.furniture = {made("desk", "desk", kAgainstWall),
                    made("monitor", "monitor", kOnTop, 1, desk),
                    made("lamp", "desk lamp", kOnTop, 1, desk),
                    made("shelf", "wall shelf", kOnWall, 1, {}, 1.4f),
                    made("picture", "picture", kOnWall, 2),
                    made("window", "window", kInWall),
                    made("box", "basket", kOnFloor),
                    made("ceiling lamp", "ceiling lamp", kOnCeiling)};
  spec.clutter = {{desk, all_made({"mouse pad"}), 0, 1},
                  {desk, all_made({"keyboard"}), 1, 1},
                  {desk, all_made({"paper"}), 3, 5},
                  {desk, all_made({"mouse"}), 1, 1},
                  {desk, all_made({"book", "notebook", "folder", "envelope"}), 3, 6},
                  {desk, all_made({"pen"}), 3, 5},
                  {desk,
                   all_made({"phone", "mug", "calculator", "cable", "sticky notes", "stapler",
                             "charger", "glasses", "headphones", "pen holder", "tape", "card",
                             "desk calendar", "ruler", "scissors", "keys", "tablet"}),
                   12, 16},
                  {{"shelf"}, all_made({"standing book"}), 3, 6},
                  {{"shelf"}, all_made({"potted plant", "photo stand", "mug"}), 1, 2}};
  return {std::move(spec), "desk"};
}

DeskCorner laid_table(RoomSpec spec) {
  const Names table = {"table"};
  spec.furniture = {made("table", "table", kAgainstWall), made("picture", "picture", kOnWall, 2),
                    made("window", "window", kInWall), made("chair", "chair", kOnFloor),
                    made("ceiling lamp", "ceiling lamp", kOnCeiling)};
  spec.clutter = {{table, all_made({"place mat"}), 1, 2},
                  {table, all_made({"tray"}), 1, 1},
                  {table, all_made({"plate"}), 2, 4},
                  {table, all_made({"magazine", "envelope", "paper", "photo print", "card"}), 5, 7},
                  {table, all_made({"mug", "glass", "bowl", "bottle", "can", "carton"}), 6, 9},
                  {table, all_made({"cutlery"}), 4, 6},
                  {table,
                   all_made({"keys", "phone", "remote control", "game pad", "glasses", "tissue box",
                             "book", "potted plant"}),
                   5, 8}};
  return {std::move(spec), "table"};
}

DeskCorner full_shelf(RoomSpec spec) {
  const Names shelf = {"bookshelf"};
  spec.furniture = {made("bookshelf", "bookshelf", kAgainstWall), made("plant", "plant", kInCorner),
                    made("picture", "picture", kOnWall, 1), made("window", "window", kInWall),
                    made("ceiling lamp", "ceiling lamp", kOnCeiling)};
  spec.clutter = {
      {shelf, all_made({"standing book"}), 1, 5},
      {shelf,
       all_made({"book", "box", "vase", "photo stand", "bowl", "mug", "folder", "can", "tape",
                 "carton", "headphones"}),
       3, 5},
      {shelf,
       all_made({"card", "keys", "pen", "charger", "sticky notes", "remote control", "game pad"}),
       1, 2}};
  return {std::move(spec), "bookshelf"};
}

}  // namespace

std::vector<DeskCorner> desk_corners() {
  const RoomLight warm{1.f, 0.6f, 0.8f, {1.06f, 1.f, 0.9f}},
      cool{0.6f, 1.4f, 1.f, {0.97f, 1.f, 1.05f}}, dim{0.9f, 0.7f, 0.5f, {1.f, 0.98f, 0.94f}};
  const auto tuned = [](const char* name, const RoomLight& light) {
    return corner(name, Split::kTuned, light);
  };
  const auto unseen = [](const char* name, const RoomLight& light) {
    return corner(name, Split::kUnseen, light);
  };
  return {writing_desk(tuned("writing-desk", warm)), laid_table(tuned("breakfast-table", warm)),
          full_shelf(tuned("book-shelf", warm)),     writing_desk(unseen("work-desk", cool)),
          writing_desk(unseen("evening-desk", dim)), laid_table(unseen("supper-table", dim)),
          full_shelf(unseen("open-shelf", cool))};
}

std::vector<SurveyMoment> survey_of(const SynthRoom& room, const std::string& main_class,
                                    bool upright) {
  const auto found =
      std::find_if(room.objects.begin(), room.objects.end(), [&](const RoomObject& object) {
        return object.class_name == main_class && object.footprint;
      });
  if (found == room.objects.end())
    throw Error(concat("scene '", room.name, "' (seed ", room.seed, "): its ", main_class,
                       " found no place; choose another seed"));
  const OrientedBox& piece = *found->footprint;
  std::vector<SurveyMoment> moments;
  for (int i = 0; i <= kMoments; ++i) {
    const float part = static_cast<float>(i) / kMoments;
    const float aside = std::sin(kTurn_rad * 2 * part),
                in_out = 0.5f - 0.5f * std::cos(kTurn_rad * 3 * part);
    const float away = kNearest_m + kFarther_m * in_out + (upright ? kShelfFarther_m : 0.f);
    SurveyMoment moment;
    moment.eye_m =
        piece.world_from_box({1.15f * piece.half_m.x() * aside, -piece.half_m.y() - away});
    const float across = 0.75f * piece.half_m.x() * std::sin(kTurn_rad * 2 * part + 0.5f);
    moment.target_m = piece.world_from_box(
        {across, upright ? 0.f : piece.half_m.y() * 0.5f * std::sin(kTurn_rad * 5 * part)});
    moment.target_height_m =
        upright ? piece.top_m * (0.55f + 0.4f * std::cos(kTurn_rad * part)) : piece.top_m;
    // The room is small: nobody stands in its walls.
    const Eigen::Vector2f keep = Eigen::Vector2f::Constant(0.2f);
    moment.eye_m = moment.eye_m.cwiseMax(keep).cwiseMin(room.size_m.head<2>() - keep);
    moments.push_back(moment);
  }
  return moments;
}

}  // namespace ovimap
