// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include "ovimap/synth/procedural/makers.h"
#include "ovimap/synth/procedural/prints.h"

namespace ovimap {
namespace {

using Points = std::vector<Eigen::Vector3f>;
using Profile = std::vector<Eigen::Vector2f>;
constexpr float kWall_m = 0.004f;

/// Outside up, then inside down to a bottom.
Profile hollow(const Profile& outside, float bottom) {
  Profile all = {{0.001f, 0}};
  all.insert(all.end(), outside.begin(), outside.end());
  for (std::size_t i = outside.size(); i-- > 0;)
    all.emplace_back(std::max(0.001f, outside[i].x() - kWall_m), std::max(bottom, outside[i].y()));
  all.emplace_back(0.001f, bottom);
  return all;
}

void add_handle(TexturedMesh& mesh, float radius, float low, float high, float reach,
                std::uint32_t material) {
  Points loop;
  for (int i = 0; i <= 8; ++i) {
    const float angle = std::numbers::pi_v<float> * static_cast<float>(i) / 8;
    loop.emplace_back(radius - 0.004f + reach * std::sin(angle), 0,
                      (low + high) / 2 - (high - low) / 2 * std::cos(angle));
  }
  add_bar(mesh, loop, 0.005f, material);
}

void mug(Craft& craft, MadeModel& model) {
  const auto glaze = craft.glaze(model.mesh);
  const float r = craft.between(0.035f, 0.045f), h = craft.between(0.075f, 0.11f);
  const float foot = craft.tuned() ? r : 0.65f * r;
  add_turned(model.mesh, {0, 0, 0},
             hollow({{foot, 0}, {r, craft.tuned() ? 0.01f : h * 0.6f}, {r, h}}, h * 0.7f), glaze);
  add_handle(model.mesh, r, h * 0.2f, h * 0.8f, 0.028f, glaze);
}

void glass(Craft& craft, MadeModel& model) {
  const auto body = craft.plain(model.mesh, {craft.between(0.3f, 0.9f), craft.between(0.4f, 0.9f),
                                             craft.between(0.5f, 0.95f)});
  const float r = craft.between(0.028f, 0.038f), h = craft.between(0.09f, 0.15f);
  const Profile outside = craft.tuned() ? Profile{{r * 0.8f, 0}, {r, h}}
                                        : Profile{{r, 0}, {r * 0.85f, h * 0.4f}, {r, h}};
  add_turned(model.mesh, {0, 0, 0}, hollow(outside, 0.01f), body);
}

void plate(Craft& craft, MadeModel& model) {
  const auto glaze = craft.glaze(model.mesh);
  const float r = craft.between(0.08f, 0.13f);
  add_turned(model.mesh, {0, 0, 0},
             Profile{{0.001f, 0},
                     {r * 0.6f, 0},
                     {r, 0.016f},
                     {r * 0.98f, 0.02f},
                     {r * 0.6f, 0.008f},
                     {0.001f, 0.007f}},
             glaze);
}

void bowl(Craft& craft, MadeModel& model) {
  TexturedMesh& mesh = model.mesh;
  const auto glaze = craft.glaze(mesh);
  const float r = craft.between(0.07f, 0.13f), h = r * craft.between(0.45f, 0.7f);
  add_turned(mesh, {0, 0, 0}, hollow({{r * 0.45f, 0}, {r * 0.85f, h * 0.5f}, {r, h}}, 0.01f),
             glaze);
  if (craft.one_in(2)) return;
  const auto fruit =
      craft.plain(mesh, {craft.between(0.6f, 0.95f), craft.between(0.2f, 0.8f), 0.15f});
  for (int i = 0; i < 4; ++i) {
    const float angle = 1.6f * static_cast<float>(i), f = craft.between(0.03f, 0.04f),
                at = r * 0.4f;
    const Eigen::Vector3f middle(at * std::cos(angle), at * std::sin(angle), h * 0.75f);
    add_rounded_box(mesh, middle - Eigen::Vector3f::Constant(f),
                    middle + Eigen::Vector3f::Constant(f), f, fruit);
  }
}

void bottle(Craft& craft, MadeModel& model) {
  TexturedMesh& mesh = model.mesh;
  const auto body = craft.plain(mesh, {craft.between(0.05f, 0.7f), craft.between(0.1f, 0.7f),
                                       craft.between(0.05f, 0.7f)}),
             cap = craft.plastic(mesh);
  const float r = craft.between(0.03f, 0.04f), h = craft.between(0.2f, 0.32f);
  const float shoulder = craft.tuned() ? 0.62f : 0.78f;
  add_turned(mesh, {0, 0, 0},
             Profile{{0.001f, 0},
                     {r, 0.003f},
                     {r, h * shoulder},
                     {r * 0.38f, h * (shoulder + 0.15f)},
                     {r * 0.38f, h * 0.95f}},
             body);
  add_turned(mesh, {0, 0, 0}, Profile{{r * 0.44f, h * 0.92f}, {r * 0.44f, h}, {0.001f, h}}, cap);
  const auto label = craft.print(mesh, 0.15f, 0.08f, cover(craft.split, craft.random.bits()));
  add_turned(mesh, {0, 0, 0}, Profile{{r + 4e-4f, h * 0.18f}, {r + 4e-4f, h * 0.5f}}, label);
}

void can(Craft& craft, MadeModel& model) {
  TexturedMesh& mesh = model.mesh;
  const auto label = craft.print(mesh, 0.2f, 0.1f, cover(craft.split, craft.random.bits())),
             tin = craft.plain(mesh, PaintColor::Constant(0.7f));
  const float r = craft.tuned() ? 0.033f : craft.between(0.035f, 0.05f),
              h = craft.between(0.08f, 0.13f);
  add_turned(mesh, {0, 0, 0}, Profile{{r, 0}, {r, h - 0.004f}}, label);
  add_turned(mesh, {0, 0, 0}, Profile{{r, h - 0.004f}, {r - 0.004f, h}, {0.001f, h - 0.003f}}, tin);
}

void vase(Craft& craft, MadeModel& model) {
  const auto glaze = craft.glaze(model.mesh);
  const float r = craft.between(0.045f, 0.08f), h = craft.between(0.16f, 0.32f);
  const Profile outside =
      craft.tuned() ? Profile{{r * 0.6f, 0}, {r, h * 0.4f}, {r * 0.5f, h * 0.8f}, {r * 0.65f, h}}
                    : Profile{{r, 0},
                              {r * 0.9f, h * 0.15f},
                              {r * 0.4f, h * 0.55f},
                              {r * 0.35f, h * 0.8f},
                              {r * 0.8f, h}};
  add_turned(model.mesh, {0, 0, 0}, hollow(outside, h * 0.5f), glaze);
}

void pot(Craft& craft, MadeModel& model) {
  TexturedMesh& mesh = model.mesh;
  const auto body = craft.metal(mesh), grip = craft.plastic(mesh);
  const float r = craft.between(0.09f, 0.13f),
              h = craft.tuned() ? craft.between(0.09f, 0.14f) : craft.between(0.04f, 0.06f);
  add_turned(mesh, {0, 0, 0}, hollow({{r * 0.95f, 0}, {r, h}}, craft.tuned() ? h - 0.01f : 0.01f),
             body);
  if (!craft.tuned())
    return add_bar(mesh, Points{{r, 0, h - 0.01f}, {r + 0.19f, 0, h + 0.02f}}, 0.011f, grip);
  add_turned(mesh, {0, 0, 0},
             Profile{{r, h},
                     {r * 0.5f, h + 0.025f},
                     {0.015f, h + 0.03f},
                     {0.018f, h + 0.05f},
                     {0.001f, h + 0.055f}},
             body);
  for (const float side : {-1.f, 1.f})
    add_bar(mesh,
            Points{{side * r, -0.03f, h * 0.8f},
                   {side * (r + 0.03f), 0, h * 0.8f},
                   {side * r, 0.03f, h * 0.8f}},
            0.006f, grip);
}

void kettle(Craft& craft, MadeModel& model) {
  TexturedMesh& mesh = model.mesh;
  const auto body = craft.one_in(2) ? craft.metal(mesh) : craft.lacquer(mesh),
             grip = craft.plastic(mesh);
  const float r = craft.between(0.075f, 0.09f), h = craft.between(0.17f, 0.23f);
  add_turned(mesh, {0, 0, 0},
             craft.tuned()
                 ? Profile{{r, 0}, {r * 0.95f, h * 0.4f}, {r * 0.65f, h}, {0.001f, h + 0.01f}}
                 : Profile{{r, 0}, {r * 1.1f, h * 0.3f}, {r * 0.8f, h * 0.7f}, {0.001f, h * 0.8f}},
             body);
  add_bar(mesh, Points{{-r * 0.85f, 0, h * 0.5f}, {-r * 1.35f, 0, h * 0.75f}}, 0.014f, body);
  add_handle(mesh, r * 0.8f, h * 0.2f, h * 0.9f, 0.06f, grip);
}

void cutlery(Craft& craft, MadeModel& model) {
  TexturedMesh& mesh = model.mesh;
  const auto steel = craft.plain(mesh, PaintColor::Constant(0.72f));
  const float length = craft.between(0.17f, 0.21f);
  add_rounded_box(mesh, {-0.005f, -length / 2, 0}, {0.005f, length * 0.2f, 0.004f}, 0.002f, steel);
  if (craft.tuned())
    add_rounded_box(mesh, {-0.013f, length * 0.18f, 0}, {0.013f, length / 2, 0.006f}, 0.003f,
                    steel);
  else
    for (const float x : {-0.009f, -0.003f, 0.003f, 0.009f})
      add_board(mesh, {x - 0.0015f, length * 0.2f, 0.001f}, {x + 0.0015f, length / 2, 0.004f},
                steel);
}

/// Tea, cereals, juice: a printed box.
void carton(Craft& craft, MadeModel& model) {
  TexturedMesh& mesh = model.mesh;
  const float x = craft.between(0.03f, 0.09f), y = craft.between(0.02f, 0.04f),
              h = craft.between(0.08f, 0.28f);
  const auto side = craft.plain(
      mesh, {craft.between(0.2f, 0.9f), craft.between(0.2f, 0.9f), craft.between(0.2f, 0.9f)});
  add_board(mesh, {-x, -y, 0}, {x, y, h}, side);
  const auto front = craft.print(mesh, 2 * x, h, cover(craft.split, craft.random.bits()));
  add_front_print(mesh, -x, x, 0, h, -y, front);
  model.stackable = h < 0.1f;
}

void tray(Craft& craft, MadeModel& model) {
  TexturedMesh& mesh = model.mesh;
  const auto wood = craft.one_in(2) ? craft.wood(mesh) : craft.lacquer(mesh);
  const float x = craft.between(0.16f, 0.22f), y = craft.between(0.11f, 0.15f), rim = 0.025f;
  add_board(mesh, {-x, -y, 0}, {x, y, 0.008f}, wood, kGrain_m);
  for (const float side : {-1.f, 1.f}) {
    add_board(mesh, {side < 0 ? -x : x - 0.01f, -y, 0.008f}, {side < 0 ? -x + 0.01f : x, y, rim},
              wood, kGrain_m);
    add_board(mesh, {-x + 0.01f, side < 0 ? -y : y - 0.01f, 0.008f},
              {x - 0.01f, side < 0 ? -y + 0.01f : y, rim}, wood, kGrain_m);
  }
  model.decks = {{{0, 0}, {x - 0.015f, y - 0.015f}, 0.008f}};
}

}  // namespace

void add_tableware(Makers& makers) {
  makers["mug"] = {"mug", mug};
  makers["glass"] = {"drinking glass", glass};
  makers["plate"] = {"plate", plate};
  makers["bowl"] = {"bowl", bowl};
  makers["bottle"] = {"bottle", bottle};
  makers["can"] = {"can", can};
  makers["vase"] = {"vase", vase};
  makers["pot"] = {"pot", pot};
  makers["kettle"] = {"kettle", kettle};
  makers["cutlery"] = {"cutlery", cutlery};
  makers["carton"] = {"carton", carton};
  makers["tray"] = {"tray", tray};
}

}  // namespace ovimap
