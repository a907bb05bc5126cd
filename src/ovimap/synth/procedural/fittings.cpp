// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "ovimap/synth/procedural/makers.h"
#include "ovimap/synth/procedural/prints.h"
#include "ovimap/synth/shapes/angles.h"

namespace ovimap {
namespace {

using Points = std::vector<Eigen::Vector3f>;
using Profile = std::vector<Eigen::Vector2f>;
constexpr float kShadeGlow = 1.1f, kSkyGlow = 1.7f;

void add_shade(Craft& craft, TexturedMesh& mesh, const Eigen::Vector3f& base, float radius,
               float height) {
  const auto shade = craft.plain(
      mesh, {0.98f, craft.between(0.88f, 0.95f), craft.between(0.72f, 0.9f)}, kShadeGlow);
  if (craft.tuned())
    return add_turned(mesh, base,
                      Profile{{radius, 0}, {radius * craft.between(0.5f, 0.9f), height}}, shade);
  Profile globe;
  for (int i = 0; i <= 10; ++i) {
    const float angle = 0.5f * kTurn_rad * static_cast<float>(i) / 10;
    globe.emplace_back(0.001f + radius * std::sin(angle), 0.5f * height * (1 - std::cos(angle)));
  }
  add_turned(mesh, base, globe, shade);
}

void floor_lamp(Craft& craft, MadeModel& model) {
  TexturedMesh& mesh = model.mesh;
  const auto stand = craft.metal(mesh);
  const float height = craft.between(1.3f, 1.5f), radius = craft.between(0.15f, 0.22f);
  add_turned(mesh, {0, 0, 0}, Profile{{0.14f, 0}, {0.14f, 0.02f}, {0.012f, 0.03f}}, stand);
  const float lean = craft.tuned() ? 0.f : 0.2f;
  add_bar(mesh, Points{{0, 0, 0.02f}, {0, 0, height - 0.2f}, {lean, 0, height + 0.05f}}, 0.011f,
          stand);
  add_shade(craft, mesh, {lean, 0, height - 0.05f}, radius, craft.between(0.22f, 0.3f));
  model.glow = 1;
}

void table_lamp(Craft& craft, MadeModel& model) {
  TexturedMesh& mesh = model.mesh;
  const auto foot = craft.glaze(mesh);
  const float h = craft.between(0.18f, 0.28f), r = craft.between(0.05f, 0.08f);
  add_turned(
      mesh, {0, 0, 0},
      Profile{{r * 0.7f, 0}, {r, h * 0.3f}, {r * 0.7f, h * 0.7f}, {0.012f, h}, {0.012f, h + 0.05f}},
      foot);
  const float shade = craft.between(0.1f, 0.14f);
  add_shade(craft, mesh, {0, 0, h + 0.01f}, shade, craft.between(0.14f, 0.2f));
  model.glow = 0.5f;
}

/// Two arms with joints and a hood over the desk.
void desk_lamp(Craft& craft, MadeModel& model) {
  TexturedMesh& mesh = model.mesh;
  const auto body = craft.one_in(2) ? craft.metal(mesh) : craft.lacquer(mesh);
  const float h = craft.between(0.3f, 0.42f), reach = craft.between(0.15f, 0.28f);
  add_turned(mesh, {0, 0, 0}, Profile{{0.085f, 0}, {0.085f, 0.015f}, {0.01f, 0.025f}}, body);
  add_bar(mesh, Points{{0, 0, 0.02f}, {-0.5f * reach, 0, 0.6f * h}}, 0.007f, body);
  add_bar(mesh, Points{{-0.5f * reach, 0, 0.6f * h}, {reach, 0, h}}, 0.007f, body);
  const auto bulb = craft.plain(mesh, {1, 0.95f, 0.85f}, kShadeGlow);
  add_turned(mesh, {reach, 0, h - 0.08f}, Profile{{0.065f, 0}, {0.02f, 0.09f}, {0.001f, 0.1f}},
             body);
  add_turned(mesh, {reach, 0, h - 0.07f}, Profile{{0.025f, 0}, {0.025f, 0.02f}}, bulb);
  model.glow = 0.4f;
}

void ceiling_lamp(Craft& craft, MadeModel& model) {
  TexturedMesh& mesh = model.mesh;
  const auto cord = craft.metal(mesh);
  const float drop = craft.between(0.1f, 0.4f), radius = craft.between(0.14f, 0.25f),
              height = craft.between(0.14f, 0.2f);
  add_shade(craft, mesh, {0, 0, 0}, radius, height);
  add_bar(mesh, Points{{0, 0, height}, {0, 0, height + drop}}, 0.006f, cord);
}

/// Frame, cross bars, sill; the view behind shines.
void window(Craft& craft, MadeModel& model) {
  TexturedMesh& mesh = model.mesh;
  const auto frame = craft.lacquer(mesh);
  const float x = craft.between(0.5f, 0.9f), h = craft.between(1.1f, 1.35f), w = 0.05f;
  for (const float side : {-1.f, 1.f})
    add_board(mesh, {side < 0 ? -x : x - w, -0.03f, 0}, {side < 0 ? -x + w : x, 0.03f, h}, frame);
  add_board(mesh, {-x + w, -0.03f, 0}, {x - w, 0.03f, w}, frame);
  add_board(mesh, {-x + w, -0.03f, h - w}, {x - w, 0.03f, h}, frame);
  add_board(mesh, {-0.03f, -0.025f, w}, {0.03f, 0.02f, h - w}, frame);
  if (!craft.tuned())
    add_board(mesh, {-x + w, -0.02f, h * 0.66f}, {x - w, 0.02f, h * 0.66f + 0.03f}, frame);
  const Paint outside = view_outside(craft.split, craft.random.bits());
  const auto view = craft.print(
      mesh, x, h / 2,
      [outside](float u, float v) {
        return PaintColor(mixed(outside(u, v), {0.9f, 0.95f, 1.f}, 0.45f));
      },
      kSkyGlow);
  add_panel(mesh, {-x + w, 0.025f, w}, {2 * (x - w), 0, 0}, {0, 0, h - 2 * w}, view);
}

/// Cloth in folds, hung from a bar.
void curtain(Craft& craft, MadeModel& model) {
  TexturedMesh& mesh = model.mesh;
  const auto cloth = craft.cloth(mesh), bar = craft.metal(mesh);
  const float x = craft.between(0.25f, 0.4f), top = craft.between(2.05f, 2.2f),
              folds = craft.between(5, 9), deep = craft.between(0.02f, 0.04f);
  constexpr int kSteps = 72;
  Points line;
  for (int i = 0; i <= kSteps; ++i) {
    const float part = static_cast<float>(i) / kSteps;
    const float wave = std::sin(part * folds * kTurn_rad);
    line.emplace_back(-x + 2 * x * part, deep * (craft.tuned() ? wave : wave * std::abs(wave)),
                      0.02f);
  }
  for (std::size_t i = 0; i + 1 < line.size(); ++i)
    add_panel(mesh, line[i], line[i + 1] - line[i], {0, 0, top - 0.06f}, cloth,
              {static_cast<float>(i) * 0.02f, 0},
              {static_cast<float>(i + 1) * 0.02f, top / kGrain_m});
  add_bar(mesh, Points{{-x - 0.04f, 0, top}, {x + 0.04f, 0, top}}, 0.013f, bar);
}

/// Panels or a smooth face on both sides, a handle.
void door_leaf(Craft& craft, MadeModel& model) {
  TexturedMesh& mesh = model.mesh;
  const auto face = craft.one_in(3) ? craft.wood(mesh) : craft.lacquer(mesh),
             grip = craft.metal(mesh);
  const float x = 0.42f, h = 2.f, y = 0.02f;
  add_board(mesh, {-x, -y, 0}, {x, y, h}, face, kGrain_m);
  for (const float side : {-1.f, 1.f}) {
    const float at = side * (y + 0.004f), low = std::min(side * y, at),
                high = std::max(side * y, at);
    const std::vector<float> cuts =
        craft.tuned() ? std::vector<float>{0.15f, 0.8f, 0.95f, 1.85f} : std::vector<float>{};
    for (std::size_t i = 0; i + 1 < cuts.size(); i += 2)
      add_board(mesh, {-x + 0.12f, low, cuts[i]}, {x - 0.12f, high, cuts[i + 1]}, face, kGrain_m);
    add_bar(mesh,
            Points{{x - 0.06f, side * y, 1.02f},
                   {x - 0.06f, side * 2 * y, 1.02f},
                   {x - 0.17f, side * 2 * y, 1.02f}},
            0.008f, grip);
  }
}

/// Leaves on stems out of a pot.
void plant_of(Craft& craft, MadeModel& model, const Eigen::Vector2f& size, int stems) {
  const float height = size.x(), pot = size.y();  // radius
  TexturedMesh& mesh = model.mesh;
  const auto clay = craft.glaze(mesh), earth = craft.plain(mesh, {0.2f, 0.14f, 0.1f});
  const auto green = craft.plain(
      mesh, {craft.between(0.1f, 0.35f), craft.between(0.3f, 0.55f), craft.between(0.1f, 0.25f)});
  const float pot_height = pot * craft.between(1.3f, 1.9f);
  add_turned(mesh, {0, 0, 0},
             Profile{{0.001f, 0},
                     {pot * 0.75f, 0},
                     {pot, pot_height},
                     {pot * 0.9f, pot_height},
                     {pot * 0.85f, pot_height * 0.9f}},
             clay);
  add_turned(mesh, {0, 0, pot_height * 0.88f}, Profile{{pot * 0.87f, 0}, {0.001f, 0.005f}}, earth);
  for (int i = 0; i < stems; ++i) {
    const float angle = craft.between(0, kTurn_rad), out = craft.between(0.25f, 0.9f) *
                                                           (craft.tuned() ? 0.5f : 0.3f) *
                                                           (height - pot_height);
    const float top = pot_height + (height - pot_height) * craft.between(0.5f, 1.f);
    const Eigen::Vector3f root(0, 0, pot_height * 0.9f),
        tip(out * std::cos(angle), out * std::sin(angle), top);
    const Eigen::Vector3f bend(0.4f * tip.x(), 0.4f * tip.y(), 0.75f * top);
    if (craft.tuned()) {  // broad leaves at the tips
      add_bar(mesh, Points{root, bend, tip}, 0.004f, green);
      const Eigen::Vector3f side = Eigen::Vector3f(-std::sin(angle), std::cos(angle), 0) * 0.16f *
                                   height * craft.between(0.5f, 1);
      const Eigen::Vector3f along =
          Eigen::Vector3f(std::cos(angle), std::sin(angle), craft.between(-0.7f, 0.3f)) * 0.24f *
          height;
      add_panel(mesh, tip - side / 2, along + 0.3f * side, side * 0.4f, green);
      add_panel(mesh, tip - side / 2 + side * 0.4f, along - 0.2f * side, side * 0.6f, green);
    } else {  // blades from the root
      const Eigen::Vector3f side =
          Eigen::Vector3f(-std::sin(angle), std::cos(angle), 0) * craft.between(0.012f, 0.03f);
      add_panel(mesh, root - side, bend - root, 2 * side, green);
      add_panel(mesh, bend - side, tip - bend, side * 1.2f, green);
    }
  }
}

void plant(Craft& craft, MadeModel& model) {
  plant_of(craft, model, {craft.between(0.8f, 1.4f), craft.between(0.13f, 0.18f)}, 16);
}
void potted_plant(Craft& craft, MadeModel& model) {
  plant_of(craft, model, {craft.between(0.2f, 0.38f), craft.between(0.045f, 0.07f)}, 14);
}

void rug(Craft& craft, MadeModel& model) {
  TexturedMesh& mesh = model.mesh;
  const float x = craft.between(0.6f, 1.2f), y = craft.between(0.45f, 0.8f),
              top = craft.between(0.006f, 0.012f);
  const auto edge = craft.plain(mesh, {0.5f, 0.45f, 0.4f});
  add_board(mesh, {-x, -y, 0}, {x, y, top}, edge);
  const auto motif =
      craft.print(mesh, x, y, rug_motif(craft.split, 2 * x, 2 * y, craft.random.bits()));
  add_top_print(mesh, {-x, -y}, {x, y}, top, motif);
}

void radiator(Craft& craft, MadeModel& model) {
  TexturedMesh& mesh = model.mesh;
  const auto paint = craft.plain(mesh, PaintColor::Constant(craft.between(0.86f, 0.95f)));
  const float x = craft.between(0.35f, 0.6f), h = craft.between(0.5f, 0.6f);
  const int ribs = static_cast<int>(2 * x / (craft.tuned() ? 0.045f : 0.09f));
  for (int i = 0; i < ribs; ++i) {
    const float at = -x + 2 * x * (static_cast<float>(i) + 0.5f) / static_cast<float>(ribs),
                half = 0.42f * 2 * x / static_cast<float>(ribs);
    add_rounded_box(mesh, {at - half, -0.05f, 0}, {at + half, 0.03f, h}, 0.012f, paint);
  }
  add_bar(mesh, Points{{-x, 0, 0.05f}, {x, 0, 0.05f}}, 0.016f, paint);
}

/// A bar with discs at both ends.
void barbell(Craft& craft, MadeModel& model) {
  TexturedMesh& mesh = model.mesh;
  const auto steel = craft.metal(mesh), rubber = craft.plastic(mesh);
  const float half = craft.tuned() ? craft.between(0.35f, 0.6f) : craft.between(0.15f, 0.2f),
              disc = craft.tuned() ? 0.11f : 0.055f;
  add_bar(mesh, Points{{-half, 0, disc}, {half, 0, disc}}, 0.013f, steel);
  for (const float side : {-1.f, 1.f})
    for (int i = 0; i < 2; ++i) {
      TexturedMesh weight;
      const float r = disc * (i == 0 ? 1.f : 0.75f);
      add_turned(weight, {0, 0, 0}, Profile{{0.012f, 0}, {r, 0}, {r, 0.03f}, {0.012f, 0.03f}},
                 add_material(weight, mesh.materials[rubber]));
      const float at = side * (half - 0.05f - 0.035f * static_cast<float>(i));
      add_mesh(mesh, moved(weight, Eigen::Affine3f(Eigen::Translation3f(at, 0, disc) *
                                                   Eigen::AngleAxisf(side * kTurn_rad / 4,
                                                                     Eigen::Vector3f::UnitY()))));
    }
}

void shoe_pair(Craft& craft, MadeModel& model) {
  TexturedMesh& mesh = model.mesh;
  const auto upper = craft.cloth(mesh), sole = craft.plastic(mesh);
  for (const float x : {-0.06f, 0.07f}) {
    const float y = craft.between(-0.04f, 0.04f);
    add_rounded_box(mesh, {x - 0.045f, y - 0.14f, 0}, {x + 0.045f, y + 0.14f, 0.025f}, 0.012f,
                    sole);
    add_rounded_box(mesh, {x - 0.042f, y - 0.135f, 0.02f}, {x + 0.042f, y + 0.02f, 0.065f}, 0.025f,
                    upper, kGrain_m);
    add_rounded_box(mesh, {x - 0.04f, y - 0.02f, 0.02f},
                    {x + 0.04f, y + 0.138f, craft.tuned() ? 0.1f : 0.15f}, 0.025f, upper, kGrain_m);
  }
}

void box(Craft& craft, MadeModel& model) {
  TexturedMesh& mesh = model.mesh;
  const auto card = craft.one_in(2) ? craft.plain(mesh, {0.72f, 0.56f, 0.4f}) : craft.cloth(mesh);
  const float x = craft.between(0.12f, 0.25f), y = craft.between(0.1f, 0.2f),
              h = craft.between(0.12f, 0.3f);
  add_rounded_box(mesh, {-x, -y, 0}, {x, y, h}, 0.004f, card, kGrain_m);
  const auto label = craft.print(mesh, 0.2f, 0.1f, cover(craft.split, craft.random.bits()));
  add_front_print(mesh, -x * 0.5f, x * 0.4f, h * 0.3f, h * 0.75f, -y, label);
  model.decks = {{{0, 0}, {x - 0.02f, y - 0.02f}, h}};
}

void basket(Craft& craft, MadeModel& model) {
  const auto wicker = craft.cloth(model.mesh);
  const float r = craft.between(0.12f, 0.2f), h = craft.between(0.2f, 0.45f);
  add_turned(model.mesh, {0, 0, 0},
             Profile{{0.001f, 0.002f},
                     {r * 0.85f, 0},
                     {r, h},
                     {r - 0.012f, h},
                     {r * 0.84f, 0.02f},
                     {0.001f, 0.02f}},
             wicker);
}

}  // namespace

void add_fittings(Makers& makers) {
  makers["floor lamp"] = {"floor lamp", floor_lamp};
  makers["table lamp"] = {"lamp", table_lamp};
  makers["desk lamp"] = {"lamp", desk_lamp};
  makers["ceiling lamp"] = {"ceiling lamp", ceiling_lamp};
  makers["window"] = {"window", window};
  makers["door leaf"] = {"door", door_leaf};
  makers["curtain"] = {"curtain", curtain};
  makers["plant"] = {"plant", plant};
  makers["potted plant"] = {"potted plant", potted_plant};
  makers["rug"] = {"rug", rug};
  makers["radiator"] = {"radiator", radiator};
  makers["barbell"] = {"barbell", barbell};
  makers["shoes"] = {"shoes", shoe_pair};
  makers["box"] = {"box", box};
  makers["basket"] = {"laundry basket", basket};
}

}  // namespace ovimap
