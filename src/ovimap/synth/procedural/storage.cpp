// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "ovimap/synth/procedural/makers.h"

namespace ovimap {
namespace {

using Points = std::vector<Eigen::Vector3f>;
constexpr float kBoard_m = 0.02f, kEdge_m = 0.02f;

Deck deck_over(float half_x, float half_y, float height, float clearance = 10) {
  return {{0, 0}, {half_x - kEdge_m, half_y - kEdge_m}, height, clearance};
}

/// `size`: half width, half depth, height.
void table_of(Craft& craft, MadeModel& model, const Eigen::Vector3f& size) {
  const float x = size.x(), y = size.y(), height = size.z();
  TexturedMesh& mesh = model.mesh;
  const auto top = craft.one_in(3) ? craft.lacquer(mesh) : craft.wood(mesh),
             legs = craft.one_in(2) ? craft.metal(mesh) : top;
  const float thick = craft.between(0.022f, 0.045f);
  add_rounded_box(mesh, {-x, -y, height - thick}, {x, y, height}, 0.006f, top, kGrain_m);
  if (craft.tuned()) {
    const float leg = craft.between(0.02f, 0.035f), in = craft.between(0.02f, 0.08f);
    for (const float a : {-1.f, 1.f})
      for (const float b : {-1.f, 1.f})
        add_board(mesh, {a * (x - in) - leg, b * (y - in) - leg, 0},
                  {a * (x - in) + leg, b * (y - in) + leg, height - thick}, legs, kGrain_m);
    for (const float b : {-1.f, 1.f})
      add_board(mesh, {-x + in, b * (y - in) - 0.01f, height - thick - 0.08f},
                {x - in, b * (y - in) + 0.01f, height - thick}, legs, kGrain_m);
  } else {  // trestles
    for (const float a : {-1.f, 1.f}) {
      const float at = a * (x - 0.18f);
      add_bar(mesh,
              Points{{at, -y + 0.05f, 0.02f}, {at, 0, height - thick}, {at, y - 0.05f, 0.02f}},
              0.02f, legs);
      add_bar(
          mesh,
          Points{{at, -y + 0.04f, height - thick - 0.02f}, {at, y - 0.04f, height - thick - 0.02f}},
          0.018f, legs);
    }
    add_bar(mesh, Points{{-x + 0.18f, 0, height * 0.4f}, {x - 0.18f, 0, height * 0.4f}}, 0.015f,
            legs);
  }
  model.decks = {deck_over(x, y, height)};
}

void table(Craft& craft, MadeModel& model) {
  table_of(craft, model,
           {craft.between(0.65f, 0.95f), craft.between(0.4f, 0.48f), craft.between(0.72f, 0.77f)});
}
void desk(Craft& craft, MadeModel& model) {
  table_of(craft, model,
           {craft.between(0.65f, 0.85f), craft.between(0.35f, 0.42f), craft.between(0.71f, 0.76f)});
}
void coffee_table(Craft& craft, MadeModel& model) {
  table_of(craft, model,
           {craft.between(0.4f, 0.6f), craft.between(0.25f, 0.35f), craft.between(0.34f, 0.45f)});
  const float z = craft.between(0.1f, 0.16f);
  const Deck& top = model.decks[0];
  const auto wood = craft.wood(model.mesh);
  const Eigen::Vector2f half = top.half_m - Eigen::Vector2f(0.1f, 0.04f);
  add_board(model.mesh, {-half.x(), -half.y(), z}, {half.x(), half.y(), z + kBoard_m}, wood,
            kGrain_m);
  model.decks.push_back(
      {{0, 0}, half - Eigen::Vector2f::Constant(kEdge_m), z + kBoard_m, top.height_m - z - 0.1f});
}

/// A door or drawer front: a frame round a sunk panel and a knob, or a slab with a bar to pull.
void add_front(Craft& craft, TexturedMesh& mesh, float left, float right, float bottom, float top,
               float y, std::uint32_t face, std::uint32_t grip, bool drawer) {
  const float gap = 0.003f, l = left + gap, r = right - gap, b = bottom + gap, t = top - gap;
  if (craft.tuned()) {
    const float w = std::min({0.055f, (r - l) / 4, (t - b) / 4});
    add_board(mesh, {l, y - 0.012f, b}, {r, y, t}, face, kGrain_m);
    add_board(mesh, {l, y - 0.022f, b}, {l + w, y - 0.012f, t}, face, kGrain_m);
    add_board(mesh, {r - w, y - 0.022f, b}, {r, y - 0.012f, t}, face, kGrain_m);
    add_board(mesh, {l + w, y - 0.022f, b}, {r - w, y - 0.012f, b + w}, face, kGrain_m);
    add_board(mesh, {l + w, y - 0.022f, t - w}, {r - w, y - 0.012f, t}, face, kGrain_m);
    const Eigen::Vector3f knob(drawer ? (l + r) / 2 : r - w / 2, y - 0.035f,
                               drawer ? (b + t) / 2 : (b + t) / 2);
    add_rounded_box(mesh, knob - Eigen::Vector3f::Constant(0.013f),
                    knob + Eigen::Vector3f::Constant(0.013f), 0.012f, grip);
    return;
  }
  add_rounded_box(mesh, {l, y - 0.02f, b}, {r, y, t}, 0.004f, face, kGrain_m);
  const float z = drawer ? t - 0.04f : (b + t) / 2, half = std::min(0.08f, (r - l) / 3);
  if (drawer)
    add_bar(mesh, Points{{(l + r) / 2 - half, y - 0.04f, z}, {(l + r) / 2 + half, y - 0.04f, z}},
            0.006f, grip);
  else
    add_bar(mesh, Points{{r - 0.04f, y - 0.04f, z - half}, {r - 0.04f, y - 0.04f, z + half}},
            0.006f, grip);
}

struct Case {
  Eigen::Vector3f size;  ///< half width, half depth, height
  int columns, rows;     ///< of doors (one row) or drawers
  float plinth;
  bool lacquered;
};

void case_of(Craft& craft, MadeModel& model, const Case& shape) {
  const auto& [size, columns, rows, plinth, lacquered] = shape;
  const float x = size.x(), y = size.y(), height = size.z();
  TexturedMesh& mesh = model.mesh;
  const auto body = lacquered ? craft.lacquer(mesh) : craft.wood(mesh),
             face = craft.one_in(3) ? craft.wood(mesh) : body;
  const auto grip = craft.metal(mesh);
  if (plinth > 0)
    add_board(mesh, {-x + 0.03f, -y + 0.05f, 0}, {x - 0.03f, y - 0.02f, plinth}, grip, kGrain_m);
  add_board(mesh, {-x, -y + 0.022f, plinth}, {x, y, height - kBoard_m}, body, kGrain_m);
  add_rounded_box(mesh, {-x - 0.005f, -y, height - kBoard_m}, {x + 0.005f, y, height}, 0.005f, body,
                  kGrain_m);
  const float width = 2 * x / static_cast<float>(columns);
  for (int i = 0; i < columns; ++i) {
    const bool drawers = rows > 1;
    float z = plinth;
    for (int j = 0; j < rows; ++j) {
      const float next = z + (height - kBoard_m - plinth) / static_cast<float>(rows);
      const float left = -x + width * static_cast<float>(i);
      add_front(craft, mesh, left, left + width, z, next, -y + 0.022f, face, grip, drawers);
      z = next;
    }
  }
  model.decks = {deck_over(x, y, height)};
}

void cabinet(Craft& craft, MadeModel& model) {
  const bool drawers = craft.one_in(2);
  case_of(craft, model,
          {{craft.between(0.4f, 0.8f), craft.between(0.18f, 0.24f), craft.between(0.7f, 1.f)},
           2 + static_cast<int>(craft.random.index(2)),
           drawers ? 3 : 1,
           craft.between(0.04f, 0.12f),
           craft.one_in(2)});
}
void tv_stand(Craft& craft, MadeModel& model) {
  case_of(craft, model,
          {{craft.between(0.7f, 0.95f), craft.between(0.2f, 0.24f), craft.between(0.4f, 0.55f)},
           3,
           1 + static_cast<int>(craft.random.index(2)),
           0.08f,
           craft.one_in(2)});
}
void nightstand(Craft& craft, MadeModel& model) {
  case_of(craft, model,
          {{craft.between(0.2f, 0.26f), craft.between(0.18f, 0.22f), craft.between(0.42f, 0.58f)},
           1,
           2,
           0.1f,
           craft.one_in(2)});
}
void wardrobe(Craft& craft, MadeModel& model) {
  case_of(craft, model,
          {{craft.between(0.5f, 0.9f), 0.3f, craft.between(1.95f, 2.2f)},
           2 + static_cast<int>(craft.random.index(2)),
           1,
           0.06f,
           !craft.one_in(3)});
}
void kitchen_counter(Craft& craft, MadeModel& model) {
  case_of(craft, model,
          {{craft.between(0.55f, 0.9f), 0.3f, 0.9f}, 3, craft.one_in(2) ? 3 : 1, 0.1f, true});
}
void wall_cabinet(Craft& craft, MadeModel& model) {
  case_of(craft, model,
          {{craft.between(0.4f, 0.7f), 0.16f, craft.between(0.5f, 0.65f)}, 2, 1, 0, true});
  model.decks.clear();
}
void refrigerator(Craft& craft, MadeModel& model) {
  TexturedMesh& mesh = model.mesh;
  const auto body = craft.one_in(2) ? craft.lacquer(mesh) : craft.metal(mesh),
             grip = craft.metal(mesh);
  const float x = 0.3f, y = 0.32f, height = craft.between(1.5f, 1.85f),
              split = height * (craft.tuned() ? 0.65f : 0.35f);
  add_rounded_box(mesh, {-x, -y + 0.05f, 0}, {x, y, height}, 0.01f, body);
  for (const bool upper : {false, true}) {
    const float low = upper ? split + 0.006f : 0.05f,
                high = upper ? height - 0.005f : split - 0.006f;
    add_rounded_box(mesh, {-x, -y, low}, {x, -y + 0.05f, high}, 0.012f, body);
    add_bar(mesh,
            Points{{x - 0.05f, -y - 0.03f, upper ? low + 0.05f : high - 0.35f},
                   {x - 0.05f, -y - 0.03f, upper ? low + 0.3f : high - 0.05f}},
            0.009f, grip);
  }
  model.decks = {deck_over(x, y - 0.02f, height)};
}

void stove(Craft& craft, MadeModel& model) {
  TexturedMesh& mesh = model.mesh;
  const auto body = craft.lacquer(mesh), glass = craft.plain(mesh, {0.06f, 0.06f, 0.07f}),
             grip = craft.metal(mesh);
  const float x = 0.3f, y = 0.3f;
  add_board(mesh, {-x, -y + 0.01f, 0}, {x, y, 0.88f}, body);
  add_board(mesh, {-x, -y, 0.88f}, {x, y, 0.9f}, glass);
  add_board(mesh, {-x + 0.04f, -y - 0.002f, 0.25f}, {x - 0.04f, -y + 0.01f, 0.66f}, glass);
  add_bar(mesh, Points{{-x + 0.05f, -y - 0.04f, 0.7f}, {x - 0.05f, -y - 0.04f, 0.7f}}, 0.009f,
          grip);
  for (int i = 0; i < 5; ++i) {
    const float at = -x + 0.08f + 0.11f * static_cast<float>(i);
    add_bar(mesh, Points{{at, -y - 0.03f, 0.8f}, {at, -y + 0.02f, 0.8f}},
            craft.tuned() ? 0.02f : 0.014f, grip);
  }
  model.decks = {deck_over(x, y, 0.9f)};
}

/// Shelves between sides with a back, or boards on bars without one.
void bookshelf(Craft& craft, MadeModel& model) {
  TexturedMesh& mesh = model.mesh;
  const auto wood = craft.one_in(2) ? craft.lacquer(mesh) : craft.wood(mesh),
             bars = craft.metal(mesh);
  const float x = craft.between(0.38f, 0.6f), y = craft.between(0.13f, 0.18f),
              height = craft.between(1.5f, 2.f);
  const int rows = 4 + static_cast<int>(craft.random.index(2));
  const float step = (height - 0.08f) / static_cast<float>(rows);
  if (craft.tuned()) {
    for (const float side : {-1.f, 1.f})
      add_board(mesh, {side < 0 ? -x : x - kBoard_m, -y, 0},
                {side < 0 ? -x + kBoard_m : x, y, height}, wood, kGrain_m);
    add_board(mesh, {-x, y - 0.006f, 0}, {x, y, height}, wood, kGrain_m);
  } else {
    for (const float a : {-1.f, 1.f})
      for (const float b : {-1.f, 1.f})
        add_bar(mesh,
                Points{{a * (x - 0.02f), b * (y - 0.01f), 0},
                       {a * (x - 0.02f), b * (y - 0.01f), height}},
                0.011f, bars);
    add_bar(mesh, Points{{-x + 0.02f, y, 0.1f}, {x - 0.02f, y, height - 0.1f}}, 0.005f, bars);
  }
  for (int i = 0; i <= rows; ++i) {
    const float z = 0.06f + step * static_cast<float>(i);
    add_board(mesh, {-x, -y, z - kBoard_m}, {x, y - 0.006f, z}, wood, kGrain_m);
    model.decks.push_back(
        {{0, -0.005f}, {x - 0.03f, y - 0.02f}, z, i == rows ? 0.6f : step - 0.05f});
  }
}

/// A board on brackets, hung on the wall.
void wall_shelf(Craft& craft, MadeModel& model) {
  TexturedMesh& mesh = model.mesh;
  const auto wood = craft.wood(mesh), bars = craft.metal(mesh);
  const float x = craft.between(0.4f, 0.7f), y = craft.between(0.1f, 0.14f);
  add_board(mesh, {-x, -y, 0.15f}, {x, y, 0.15f + (craft.tuned() ? 0.02f : 0.035f)}, wood,
            kGrain_m);
  for (const float side : {-0.7f, 0.7f})
    add_bar(
        mesh,
        Points{
            {side * x, y - 0.01f, 0}, {side * x, y - 0.01f, 0.14f}, {side * x, -y + 0.03f, 0.145f}},
        0.006f, bars);
  model.decks = {{{0, 0}, {x - 0.02f, y - 0.01f}, 0.15f + (craft.tuned() ? 0.02f : 0.035f), 0.4f}};
}

}  // namespace

void add_storage(Makers& makers) {
  makers["table"] = {"table", table};
  makers["desk"] = {"desk", desk};
  makers["coffee table"] = {"coffee table", coffee_table};
  makers["cabinet"] = {"cabinet", cabinet};
  makers["tv stand"] = {"tv stand", tv_stand};
  makers["nightstand"] = {"nightstand", nightstand};
  makers["wardrobe"] = {"wardrobe", wardrobe};
  makers["kitchen counter"] = {"kitchen cabinet", kitchen_counter};
  makers["wall cabinet"] = {"wall cabinet", wall_cabinet};
  makers["refrigerator"] = {"refrigerator", refrigerator};
  makers["stove"] = {"stove", stove};
  makers["bookshelf"] = {"bookshelf", bookshelf};
  makers["wall shelf"] = {"shelf", wall_shelf};
}

}  // namespace ovimap
