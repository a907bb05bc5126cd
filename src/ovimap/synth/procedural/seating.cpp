// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "ovimap/synth/procedural/makers.h"

namespace ovimap {
namespace {

using Points = std::vector<Eigen::Vector3f>;
constexpr float kSeam_m = 0.012f;

void add_legs(Craft& craft, TexturedMesh& mesh, float half_x, float half_y, float height,
              float radius, std::uint32_t material) {
  const float splay = craft.tuned() ? 0.f : 0.06f;
  for (const float x : {-1.f, 1.f})
    for (const float y : {-1.f, 1.f})
      add_bar(
          mesh,
          Points{{x * (half_x + splay), y * (half_y + splay), 0}, {x * half_x, y * half_y, height}},
          radius, material);
}

/// A row of cushions between `left` and `right`.
void add_cushions(Craft& craft, TexturedMesh& mesh, int count, float left, float right, float front,
                  float back, float bottom, float top, std::uint32_t cloth) {
  const float width = (right - left) / static_cast<float>(count);
  for (int i = 0; i < count; ++i) {
    const float x = left + width * static_cast<float>(i), give = craft.between(0, 0.02f);
    add_rounded_box(mesh, {x + kSeam_m, front + give, bottom},
                    {x + width - kSeam_m, back, top - 0.3f * give}, craft.between(0.04f, 0.07f),
                    cloth, kGrain_m);
  }
}

/// Square arms, cushions in rows: seats, backs, loose ones before them.
void block_sofa(Craft& craft, MadeModel& model, float width, int seats) {
  TexturedMesh& mesh = model.mesh;
  const auto cloth = craft.cloth(mesh), legs = craft.wood(mesh);
  const float depth = craft.between(0.85f, 0.98f), seat = craft.between(0.4f, 0.46f);
  const float arm = craft.between(0.12f, 0.24f), back = craft.between(0.72f, 0.85f), x = width / 2,
              y = depth / 2;
  const float arm_top = craft.between(0.52f, 0.64f);
  add_legs(craft, mesh, x - 0.1f, y - 0.1f, 0.12f, 0.022f, legs);
  add_rounded_box(mesh, {-x, -y + 0.03f, 0.1f}, {x, y, 0.26f}, 0.02f, cloth, kGrain_m);
  add_rounded_box(mesh, {-x, y - 0.2f, 0.1f}, {x, y, back - 0.1f}, 0.05f, cloth, kGrain_m);
  for (const float side : {-1.f, 1.f})
    add_rounded_box(mesh, {side < 0 ? -x : x - arm, -y, 0.1f},
                    {side < 0 ? -x + arm : x, y, arm_top}, 0.05f, cloth, kGrain_m);
  add_cushions(craft, mesh, seats, -x + arm, x - arm, -y, y - 0.22f, 0.26f, seat, cloth);
  add_cushions(craft, mesh, seats, -x + arm, x - arm, y - 0.36f, y - 0.18f, seat - 0.02f, back,
               cloth);
  model.decks = {{{0, -0.05f}, {x - arm - 0.05f, y - 0.3f}, seat}};
}

/// Round arms, a back of upright panels, one long seat, often with a chaise at one end.
void panel_sofa(Craft& craft, MadeModel& model, float width, int seats, bool chaise) {
  TexturedMesh& mesh = model.mesh;
  const auto cloth = craft.cloth(mesh), legs = craft.metal(mesh);
  const float depth = craft.between(0.85f, 0.95f), seat = craft.between(0.38f, 0.45f),
              back = craft.between(0.74f, 0.9f);
  const float x = width / 2, y = depth / 2, roll = craft.between(0.08f, 0.12f);
  add_legs(craft, mesh, x - 0.15f, y - 0.12f, 0.14f, 0.012f, legs);
  add_rounded_box(mesh, {-x, -y, 0.14f}, {x, y, 0.24f}, 0.03f, cloth, kGrain_m);
  add_rounded_box(mesh, {-x + 0.05f, -y - 0.02f, 0.23f}, {x - 0.05f, y - 0.18f, seat}, 0.07f, cloth,
                  kGrain_m);
  add_cushions(craft, mesh, 3 * seats, -x + 0.05f, x - 0.05f, y - 0.22f, y, 0.2f, back, cloth);
  for (const float side : {-1.f, 1.f}) {
    add_bar(mesh,
            Points{{side * (x - roll), -y, seat + 0.12f}, {side * (x - roll), y, seat + 0.12f}},
            roll, cloth);
    add_rounded_box(mesh, {side < 0 ? -x : x - 2 * roll, -y, 0.14f},
                    {side < 0 ? -x + 2 * roll : x, y, seat + 0.12f}, 0.03f, cloth, kGrain_m);
  }
  if (chaise)
    for (const float low : {0.14f, 0.24f})
      add_rounded_box(mesh, {x - 2 * roll - 0.7f, -y - 0.7f, low},
                      {x - 2 * roll, -y + 0.02f, low < 0.2f ? 0.24f : seat}, 0.05f, cloth,
                      kGrain_m);
  model.decks = {{{0, -0.05f}, {x - 2 * roll - 0.05f, y - 0.28f}, seat}};
}

void sofa(Craft& craft, MadeModel& model) {
  const int seats = 2 + static_cast<int>(craft.random.index(2));
  const float width = 0.5f + 0.68f * static_cast<float>(seats);
  if (craft.tuned()) return block_sofa(craft, model, width, seats);
  panel_sofa(craft, model, width, seats, craft.one_in(2));
}

void armchair(Craft& craft, MadeModel& model) {
  if (craft.tuned()) return block_sofa(craft, model, craft.between(0.85f, 1.f), 1);
  panel_sofa(craft, model, craft.between(0.85f, 1.f), 1, false);
}

/// Four legs and a back of slats, or a shell on bent bars.
void chair(Craft& craft, MadeModel& model) {
  TexturedMesh& mesh = model.mesh;
  const float half = craft.between(0.2f, 0.23f), seat = craft.between(0.44f, 0.48f),
              top = craft.between(0.82f, 0.98f);
  if (craft.tuned()) {
    const auto wood = craft.wood(mesh), cloth = craft.one_in(2) ? craft.cloth(mesh) : wood;
    add_legs(craft, mesh, half - 0.03f, half - 0.03f, seat - 0.03f, 0.018f, wood);
    add_rounded_box(mesh, {-half, -half, seat - 0.035f}, {half, half, seat}, 0.012f, cloth,
                    kGrain_m);
    for (const float x : {-1.f, 1.f})
      add_bar(mesh,
              Points{{x * (half - 0.03f), half - 0.03f, seat - 0.03f},
                     {x * (half - 0.03f), half + 0.03f, top}},
              0.016f, wood);
    const int slats = 2 + static_cast<int>(craft.random.index(3));
    for (int i = 0; i < slats; ++i) {
      const float z =
          seat + 0.12f + (top - seat - 0.2f) * static_cast<float>(i) / static_cast<float>(slats);
      add_board(mesh, {-half + 0.03f, half - 0.02f, z}, {half - 0.03f, half + 0.01f, z + 0.07f},
                wood, kGrain_m);
    }
    return;
  }
  const auto shell = craft.one_in(2) ? craft.plastic(mesh) : craft.cloth(mesh),
             bars = craft.metal(mesh);
  add_rounded_box(mesh, {-half, -half, seat - 0.03f}, {half, half, seat + 0.01f}, 0.02f, shell,
                  kGrain_m);
  add_rounded_box(mesh, {-half + 0.01f, half - 0.02f, seat + 0.06f},
                  {half - 0.01f, half + 0.02f, top}, 0.018f, shell, kGrain_m);
  for (const float x : {-1.f, 1.f})
    add_bar(mesh,
            Points{{x * half, half, top - 0.2f},
                   {x * half, half, seat},
                   {x * half, -half, seat - 0.02f},
                   {x * half, -half, 0.012f},
                   {x * half, half, 0.012f}},
            0.011f, bars);
}

void stool(Craft& craft, MadeModel& model) {
  TexturedMesh& mesh = model.mesh;
  const auto top = craft.wood(mesh), legs = craft.metal(mesh);
  const float radius = craft.between(0.16f, 0.2f), height = craft.between(0.42f, 0.5f);
  const auto plate = [&](float low, float high) {
    return std::array<Eigen::Vector2f, 4>{
        {{0.001f, low}, {radius, low}, {radius, high}, {0.001f, high}}};
  };
  add_turned(mesh, {0, 0, 0}, plate(height - 0.035f, height), top);
  if (craft.tuned())
    add_legs(craft, mesh, radius * 0.55f, radius * 0.55f, height - 0.03f, 0.014f, legs);
  else {
    add_bar(mesh, Points{{0, 0, 0.02f}, {0, 0, height - 0.03f}}, 0.025f, legs);
    add_turned(mesh, {0, 0, 0},
               std::array<Eigen::Vector2f, 3>{{{radius, 0}, {radius, 0.015f}, {0.02f, 0.03f}}},
               legs);
  }
  const float deck = 0.65f * radius;
  model.decks = {{{0, 0}, {deck, deck}, height}};
}

void pouf(Craft& craft, MadeModel& model) {
  const float half = craft.between(0.2f, 0.3f), height = craft.between(0.32f, 0.42f);
  const auto cloth = craft.cloth(model.mesh);
  if (craft.tuned())
    add_rounded_box(model.mesh, {-half, -half, 0}, {half, half, height}, 0.06f, cloth, kGrain_m);
  else
    add_turned(model.mesh, {0, 0, 0},
               std::array<Eigen::Vector2f, 6>{{{half * 0.8f, 0},
                                               {half, 0.1f},
                                               {half, height - 0.1f},
                                               {half * 0.85f, height - 0.02f},
                                               {half * 0.5f, height},
                                               {0.001f, height}}},
               cloth);
  model.decks = {{{0, 0}, {0.6f * half, 0.6f * half}, height}};
}

/// Slats or panels at the head, a mattress, a duvet that hangs over, pillows of its own.
void bed(Craft& craft, MadeModel& model) {
  TexturedMesh& mesh = model.mesh;
  const auto frame = craft.one_in(2) ? craft.wood(mesh) : craft.cloth(mesh);
  const auto sheet = craft.plain(mesh, PaintColor::Constant(craft.between(0.85f, 0.95f))),
             duvet = craft.cloth(mesh);
  const float x = craft.between(0.5f, 0.9f), y = 1.02f, top = craft.between(0.42f, 0.55f),
              head = craft.between(0.85f, 1.2f);
  add_board(mesh, {-x, -y, 0.1f}, {x, y, 0.28f}, frame, kGrain_m);
  add_legs(craft, mesh, x - 0.1f, y - 0.12f, 0.12f, 0.03f, frame);
  if (craft.tuned())
    add_rounded_box(mesh, {-x - 0.02f, y, 0.1f}, {x + 0.02f, y + 0.07f, head}, 0.02f, frame,
                    kGrain_m);
  else
    add_cushions(craft, mesh, 5, -x, x, y, y + 0.09f, 0.2f, head, frame);
  add_rounded_box(mesh, {-x + 0.02f, -y + 0.02f, 0.27f}, {x - 0.02f, y - 0.01f, top}, 0.05f, sheet,
                  kGrain_m);
  const float fold = craft.between(0.3f, 0.6f);
  add_rounded_box(mesh, {-x - 0.03f, -y - 0.02f, top - 0.15f}, {x + 0.03f, y - fold, top + 0.035f},
                  0.035f, duvet, kGrain_m);
  add_rounded_box(mesh, {-x - 0.02f, y - fold - 0.18f, top}, {x + 0.02f, y - fold, top + 0.055f},
                  0.027f, sheet, kGrain_m);
  for (const float side : x > 0.7f ? std::vector<float>{-0.5f, 0.5f} : std::vector<float>{0.f})
    add_rounded_box(mesh, {side * x - 0.3f, y - 0.44f, top - 0.01f},
                    {side * x + 0.3f, y - 0.05f, top + 0.12f}, 0.065f, sheet, kGrain_m);
  model.decks = {{{0, -0.4f}, {x - 0.2f, 0.4f}, top + 0.035f}};
}

void cushion(Craft& craft, MadeModel& model) {
  const auto cloth = craft.cloth(model.mesh);
  const float half = craft.between(0.19f, 0.25f);
  const float share = craft.between(0.6f, 1), thick = craft.between(0.1f, 0.15f);
  add_rounded_box(model.mesh, {-half, -half * share, 0}, {half, half, thick}, 0.055f, cloth,
                  kGrain_m);
  model.soft = true;
}

void blanket(Craft& craft, MadeModel& model) {
  const auto cloth = craft.cloth(model.mesh);
  const float x = craft.between(0.2f, 0.35f), y = craft.between(0.15f, 0.25f);
  for (int i = 0; i < 3; ++i) {
    const float left = craft.between(0, 0.03f), right = craft.between(0, 0.03f),
                low = 0.022f * static_cast<float>(i);
    add_rounded_box(model.mesh, {left - x, -y, low}, {x - right, y, low + 0.024f}, 0.011f, cloth,
                    kGrain_m);
  }
  model.soft = true;
}

}  // namespace

void add_seating(Makers& makers) {
  makers["sofa"] = {"sofa", sofa};
  makers["armchair"] = {"armchair", armchair};
  makers["chair"] = {"chair", chair};
  makers["stool"] = {"stool", stool};
  makers["pouf"] = {"stool", pouf};
  makers["bed"] = {"bed", bed};
  makers["cushion"] = {"pillow", cushion};
  makers["folded blanket"] = {"blanket", blanket};
}

}  // namespace ovimap
