// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "ovimap/synth/procedural/makers.h"
#include "ovimap/synth/procedural/prints.h"
#include "ovimap/synth/shapes/angles.h"

namespace ovimap {
namespace {

using Points = std::vector<Eigen::Vector3f>;
using Profile = std::vector<Eigen::Vector2f>;

void keyboard(Craft& craft, MadeModel& model) {
  TexturedMesh& mesh = model.mesh;
  const auto body = craft.plastic(mesh);
  const bool whole = craft.one_in(2);
  const float x = whole ? craft.between(0.2f, 0.22f) : craft.between(0.14f, 0.16f),
              y = craft.between(0.055f, 0.075f), h = craft.tuned() ? 0.022f : 0.012f;
  add_rounded_box(mesh, {-x, -y, 0}, {x, y, h}, 0.004f, body);
  const PaintColor keys = PaintColor::Constant(craft.one_in(2) ? craft.between(0.07f, 0.2f)
                                                               : craft.between(0.8f, 0.95f));
  const PaintColor ground = keys * craft.between(0.5f, 0.8f);
  const auto rows = craft.print(
      mesh, 2 * x, 2 * y,
      key_rows(whole ? 21 : 15, craft.tuned() ? 6 : 5, keys, ground, craft.random.bits()));
  add_top_print(mesh, {-x + 0.008f, -y + 0.008f}, {x - 0.008f, y - 0.008f}, h, rows);
}

void mouse(Craft& craft, MadeModel& model) {
  TexturedMesh& mesh = model.mesh;
  const auto body = craft.plastic(mesh), wheel = craft.metal(mesh);
  const float x = craft.between(0.028f, 0.034f), y = craft.between(0.048f, 0.058f),
              h = craft.between(0.026f, 0.038f);
  add_rounded_box(mesh, {-x, -y, 0}, {x, y, h}, craft.tuned() ? 0.02f : 0.013f, body);
  add_rounded_box(mesh, {-0.004f, -y * 0.7f, h - 0.006f}, {0.004f, -y * 0.25f, h + 0.002f}, 0.003f,
                  wheel);
}

void pen(Craft& craft, MadeModel& model) {
  TexturedMesh& mesh = model.mesh;
  const auto body = craft.plain(mesh, {craft.between(0.05f, 0.95f), craft.between(0.05f, 0.9f),
                                       craft.between(0.05f, 0.9f)}),
             tip = craft.metal(mesh);
  const float r = craft.between(0.004f, 0.008f), half = craft.between(0.065f, 0.08f);
  add_bar(mesh, Points{{-half, 0, r}, {half * 0.8f, 0, r}}, r, body);
  add_bar(mesh, Points{{half * 0.8f, 0, r}, {half, 0, r}}, craft.tuned() ? r * 0.6f : r, tip);
  if (!craft.tuned())
    add_board(mesh, {half * 0.4f, -0.0015f, 2 * r}, {half * 0.95f, 0.0015f, 2 * r + 0.002f}, tip);
}

void phone(Craft& craft, MadeModel& model) {
  TexturedMesh& mesh = model.mesh;
  const auto body = craft.plastic(mesh);
  const float x = craft.between(0.034f, 0.039f), y = craft.between(0.07f, 0.08f);
  add_rounded_box(mesh, {-x, -y, 0}, {x, y, 0.009f}, 0.004f, body);
  const auto shown =
      craft.one_in(2)
          ? craft.print(mesh, 0.2f, 0.4f, screen_picture(craft.split, craft.random.bits()), 0.6f)
          : craft.plain(mesh, {0.03f, 0.03f, 0.04f});
  add_top_print(mesh, {-x + 0.003f, -y + 0.005f}, {x - 0.003f, y - 0.005f}, 0.009f, shown);
}

void tablet(Craft& craft, MadeModel& model) {
  TexturedMesh& mesh = model.mesh;
  const auto body = craft.plastic(mesh);
  add_rounded_box(mesh, {-0.085f, -0.12f, 0}, {0.085f, 0.12f, 0.009f}, 0.004f, body);
  add_top_print(
      mesh, {-0.077f, -0.11f}, {0.077f, 0.11f}, 0.009f,
      craft.print(mesh, 0.4f, 0.6f, screen_picture(craft.split, craft.random.bits()), 0.6f));
}

/// A remote control, a calculator, a telephone's handset: keys on a small box.
/// `shown`: where the keys end, of the half depth.
void keypad_of(Craft& craft, MadeModel& model, const Eigen::Vector3f& size, int columns, int rows,
               float shown) {
  const float x = size.x(), y = size.y(), h = size.z();
  TexturedMesh& mesh = model.mesh;
  const auto body = craft.plastic(mesh);
  add_rounded_box(mesh, {-x, -y, 0}, {x, y, h}, 0.005f, body);
  const PaintColor keys{craft.between(0.3f, 0.9f), craft.between(0.3f, 0.9f),
                        craft.between(0.3f, 0.9f)};
  add_top_print(
      mesh, {-x + 0.005f, -y + 0.006f}, {x - 0.005f, y * shown}, h,
      craft.print(mesh, 0.2f, 0.4f,
                  key_rows(columns, rows, keys, PaintColor::Constant(0.12f), craft.random.bits())));
}
void remote_control(Craft& craft, MadeModel& model) {
  keypad_of(craft, model, {craft.between(0.02f, 0.026f), craft.between(0.07f, 0.11f), 0.018f}, 3,
            craft.tuned() ? 11 : 6, 0.9f);
}
void calculator(Craft& craft, MadeModel& model) {
  keypad_of(craft, model, {craft.between(0.035f, 0.05f), craft.between(0.06f, 0.08f), 0.014f},
            craft.tuned() ? 5 : 4, 6, 0.4f);
  const auto glass = craft.plain(model.mesh, {0.6f, 0.68f, 0.6f});
  const float top = bounds(model.mesh).max().z();
  add_top_print(model.mesh, {-0.03f, 0.03f}, {0.03f, 0.05f}, top, glass);
}

/// One that lies as it fell: loops or a wave.
void cable(Craft& craft, MadeModel& model) {
  const auto rubber = craft.plastic(model.mesh), plug = craft.plastic(model.mesh);
  const float r = craft.between(0.002f, 0.0035f), size = craft.between(0.05f, 0.09f),
              turns = craft.between(1.5f, 3.2f);
  Points line;
  for (int i = 0; i <= 90; ++i) {
    const float t = static_cast<float>(i) / 90;
    const float angle = t * turns * kTurn_rad, reach = size * (0.75f + 0.25f * std::sin(5 * t));
    if (craft.tuned())
      line.emplace_back(reach * std::cos(angle) + 0.04f * t, reach * std::sin(angle),
                        r + 2 * r * t * (turns - 1));
    else
      line.emplace_back(3 * size * (t - 0.5f),
                        0.6f * size * std::sin(t * turns * kTurn_rad) * (1 - 0.5f * t), r);
  }
  add_bar(model.mesh, line, r, rubber);
  const Eigen::Vector3f end = line.back();
  add_rounded_box(model.mesh, end - Eigen::Vector3f(0.008f, 0.012f, r),
                  end + Eigen::Vector3f(0.008f, 0.012f, 0.009f), 0.002f, plug);
}

void charger(Craft& craft, MadeModel& model) {
  const auto body = craft.plastic(model.mesh);
  const float x = craft.between(0.022f, 0.05f);
  add_rounded_box(model.mesh, {-x, -0.025f, 0}, {x, 0.025f, craft.between(0.022f, 0.035f)}, 0.006f,
                  body);
}

void headphones(Craft& craft, MadeModel& model) {
  TexturedMesh& mesh = model.mesh;
  const auto shell = craft.plastic(mesh), pad = craft.cloth(mesh);
  Points band;
  for (int i = 0; i <= 16; ++i) {
    const float angle = 0.5f * kTurn_rad * static_cast<float>(i) / 16;
    band.emplace_back(0.085f * std::cos(angle), 0.1f * std::sin(angle) - 0.02f, 0.022f);
  }
  add_bar(mesh, band, craft.tuned() ? 0.007f : 0.011f, shell);
  for (const float side : {-1.f, 1.f})
    add_rounded_box(mesh, {side * 0.085f - 0.018f, -0.06f, 0},
                    {side * 0.085f + 0.018f, 0.015f, 0.07f}, 0.017f, pad, kGrain_m);
}

void scissors(Craft& craft, MadeModel& model) {
  TexturedMesh& mesh = model.mesh;
  const auto steel = craft.plain(mesh, PaintColor::Constant(0.7f)),
             grip = craft.plain(mesh, {craft.between(0.1f, 0.9f), craft.between(0.05f, 0.4f),
                                       craft.between(0.05f, 0.7f)});
  const float open = craft.between(0.006f, 0.03f);
  for (const float side : {-1.f, 1.f}) {
    add_bar(mesh, Points{{side * -0.01f, -0.01f, 0.004f}, {side * open, 0.1f, 0.004f}}, 0.004f,
            steel);
    Points loop;
    for (int i = 0; i <= 14; ++i) {
      const float angle = kTurn_rad * static_cast<float>(i) / 14;
      loop.emplace_back(side * 0.022f + 0.017f * std::cos(angle),
                        -0.04f + (craft.tuned() ? 0.02f : 0.03f) * std::sin(angle), 0.006f);
    }
    add_bar(mesh, loop, 0.005f, grip);
  }
}

void stapler(Craft& craft, MadeModel& model) {
  TexturedMesh& mesh = model.mesh;
  const auto body = craft.plain(mesh, {craft.between(0.05f, 0.8f), craft.between(0.05f, 0.5f),
                                       craft.between(0.05f, 0.6f)}),
             steel = craft.metal(mesh);
  add_rounded_box(mesh, {-0.018f, -0.065f, 0}, {0.018f, 0.065f, 0.012f}, 0.004f, steel);
  const TexturedMesh base = mesh;
  TexturedMesh lever;
  add_rounded_box(lever, {-0.016f, -0.06f, 0.02f},
                  {0.016f, 0.065f, craft.tuned() ? 0.042f : 0.034f}, 0.01f,
                  add_material(lever, mesh.materials[body]));
  add_mesh(mesh,
           moved(lever, Eigen::Affine3f(Eigen::AngleAxisf(-0.12f, Eigen::Vector3f::UnitX()))));
}

void tape_roll(Craft& craft, MadeModel& model) {
  const auto tape = craft.plain(model.mesh, {craft.between(0.5f, 0.9f), craft.between(0.4f, 0.85f),
                                             craft.between(0.2f, 0.6f)});
  const float r = craft.between(0.03f, 0.055f), h = craft.between(0.015f, 0.05f),
              hole = r * (craft.tuned() ? 0.75f : 0.5f);
  add_turned(model.mesh, {0, 0, 0}, Profile{{hole, 0}, {r, 0}, {r, h}, {hole, h}, {hole, 0}}, tape);
}

void pen_holder(Craft& craft, MadeModel& model) {
  TexturedMesh& mesh = model.mesh;
  const auto cup = craft.glaze(mesh);
  const float r = craft.between(0.035f, 0.045f), h = craft.between(0.09f, 0.11f);
  add_turned(mesh, {0, 0, 0},
             Profile{{0.001f, 0},
                     {r, 0},
                     {craft.tuned() ? r : r * 1.15f, h},
                     {r * 0.9f, h},
                     {r * 0.85f, 0.02f}},
             cup);
  for (int i = 0; i < 6; ++i) {
    const auto color = craft.plain(mesh, {craft.between(0.05f, 0.95f), craft.between(0.05f, 0.9f),
                                          craft.between(0.05f, 0.9f)});
    const float a = craft.between(0, kTurn_rad), b = a + craft.between(2, 4), lean = 0.75f * r;
    const float top = h + craft.between(0.02f, 0.06f), thick = craft.between(0.0035f, 0.006f);
    add_bar(mesh,
            Points{{0.5f * lean * std::cos(b), 0.5f * lean * std::sin(b), 0.01f},
                   {lean * std::cos(a), lean * std::sin(a), top}},
            thick, color);
  }
}

void glasses(Craft& craft, MadeModel& model) {
  const auto frame = craft.plastic(model.mesh);
  for (const float side : {-1.f, 1.f}) {
    Points rim;
    for (int i = 0; i <= 14; ++i) {
      const float angle = kTurn_rad * static_cast<float>(i) / 14;
      rim.emplace_back(side * 0.035f + 0.026f * std::cos(angle), 0,
                       0.022f + 0.02f * std::sin(angle));
    }
    add_bar(model.mesh, rim, craft.tuned() ? 0.0022f : 0.0035f, frame);
    add_bar(model.mesh,
            Points{{side * 0.061f, 0, 0.028f},
                   {side * 0.066f, 0.1f, 0.026f},
                   {side * 0.062f, 0.135f, 0.01f}},
            0.0022f, frame);
  }
  add_bar(model.mesh, Points{{-0.01f, 0, 0.026f}, {0.01f, 0, 0.026f}}, 0.002f, frame);
}

void tissue_box(Craft& craft, MadeModel& model) {
  TexturedMesh& mesh = model.mesh;
  const float x = 0.115f, y = craft.tuned() ? 0.06f : 0.1f, h = craft.between(0.06f, 0.09f);
  const auto side = craft.print(mesh, 0.2f, 0.1f,
                                rug_motif(craft.split, 1, 0.6f, craft.random.bits())),
             white = craft.plain(mesh, PaintColor::Constant(0.95f));
  add_board(mesh, {-x, -y, 0}, {x, y, h}, side, 0.2f);
  add_rounded_box(mesh, {-0.05f, -0.012f, h - 0.01f}, {0.04f, 0.015f, h + 0.05f}, 0.012f, white);
}

void game_pad(Craft& craft, MadeModel& model) {
  TexturedMesh& mesh = model.mesh;
  const auto shell = craft.plastic(mesh), knob = craft.plain(mesh, PaintColor::Constant(0.35f));
  add_rounded_box(mesh, {-0.065f, -0.02f, 0.012f}, {0.065f, 0.04f, 0.045f}, 0.015f, shell);
  for (const float side : {-1.f, 1.f}) {
    add_rounded_box(mesh, {side * 0.062f - 0.017f, -0.065f, 0},
                    {side * 0.062f + 0.017f, 0.02f, 0.036f}, 0.016f, shell);
    add_turned(mesh, {side * 0.03f, -0.002f, 0.04f},
               Profile{{0.009f, 0}, {0.011f, 0.015f}, {0.001f, 0.016f}}, knob);
  }
}

void keys(Craft& craft, MadeModel& model) {
  TexturedMesh& mesh = model.mesh;
  const auto steel = craft.plain(mesh, PaintColor::Constant(0.65f)),
             tag = craft.plain(mesh, {craft.between(0.2f, 0.9f), craft.between(0.1f, 0.5f),
                                      craft.between(0.1f, 0.6f)});
  for (int i = 0; i < 3; ++i) {
    const float angle = craft.between(0, kTurn_rad);
    const Eigen::Vector3f out(std::cos(angle), std::sin(angle), 0);
    add_bar(mesh,
            Points{0.008f * out + Eigen::Vector3f(0, 0, 0.003f + 0.003f * static_cast<float>(i)),
                   0.055f * out + Eigen::Vector3f(0, 0, 0.003f)},
            0.003f, steel);
    add_rounded_box(mesh, 0.015f * out + Eigen::Vector3f(-0.009f, -0.009f, 0.001f),
                    0.015f * out + Eigen::Vector3f(0.009f, 0.009f, 0.006f), 0.002f, steel);
  }
  add_rounded_box(mesh, {-0.012f, 0.01f, 0}, {0.015f, 0.05f, 0.006f}, 0.003f, tag);
}

void block_calendar(Craft& craft, MadeModel& model) {
  TexturedMesh& mesh = model.mesh;
  const auto card_board = craft.lacquer(mesh);
  const float x = craft.between(0.07f, 0.1f), h = craft.between(0.1f, 0.14f);
  TexturedMesh side;
  add_board(side, {-x, -0.002f, 0}, {x, 0, h}, add_material(side, mesh.materials[card_board]));
  const auto page = craft.print(side, 2 * x, h, printed_page(craft.split, craft.random.bits()));
  add_front_print(side, -x, x, 0, h, -0.002f, page);
  add_mesh(mesh, moved(side, Eigen::Affine3f(Eigen::Translation3f(0, -0.035f, 0) *
                                             Eigen::AngleAxisf(-0.3f, Eigen::Vector3f::UnitX()))));
  add_mesh(mesh, moved(side, Eigen::Affine3f(Eigen::Translation3f(0, 0.035f, 0) *
                                             Eigen::AngleAxisf(0.3f, Eigen::Vector3f::UnitX()))));
}

}  // namespace

void add_desk_things(Makers& makers) {
  const std::pair<const char*, Maker> all[] = {
      {"keyboard", {"keyboard", keyboard}},
      {"mouse", {"computer mouse", mouse}},
      {"pen", {"pen", pen}},
      {"phone", {"cell phone", phone}},
      {"tablet", {"tablet", tablet}},
      {"remote control", {"remote control", remote_control}},
      {"calculator", {"calculator", calculator}},
      {"cable", {"cable", cable}},
      {"charger", {"charger", charger}},
      {"headphones", {"headphones", headphones}},
      {"scissors", {"scissors", scissors}},
      {"stapler", {"stapler", stapler}},
      {"tape", {"tape", tape_roll}},
      {"pen holder", {"pen holder", pen_holder}},
      {"glasses", {"glasses", glasses}},
      {"tissue box", {"tissue box", tissue_box}},
      {"game pad", {"game controller", game_pad}},
      {"keys", {"keys", keys}},
      {"desk calendar", {"calendar", block_calendar}}};
  for (const auto& [kind, maker] : all) makers[kind] = maker;
}

}  // namespace ovimap
