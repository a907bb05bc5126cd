// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <vector>

#include "ovimap/synth/procedural/makers.h"
#include "ovimap/synth/procedural/prints.h"

namespace ovimap {
namespace {

using Points = std::vector<Eigen::Vector3f>;
using Profile = std::vector<Eigen::Vector2f>;
constexpr float kScreenGlow = 0.75f;

void framed(Craft& craft, MadeModel& model, const Eigen::Vector2f& size) {
  const float width = size.x(), height = size.y();
  TexturedMesh& mesh = model.mesh;
  const auto frame = craft.one_in(2) ? craft.lacquer(mesh) : craft.wood(mesh);
  const float x = width / 2, w = craft.between(0.015f, 0.035f), y = 0.012f;
  const bool mounted = craft.one_in(2);
  for (const float side : {-1.f, 1.f})
    add_board(mesh, {side < 0 ? -x : x - w, -y, 0}, {side < 0 ? -x + w : x, y, height}, frame,
              kGrain_m);
  for (const float low : {0.f, height - w})
    add_board(mesh, {-x + w, -y, low}, {x - w, y, low + w}, frame, kGrain_m);
  const auto back = craft.plain(mesh, PaintColor::Constant(0.93f));
  add_board(mesh, {-x + w, -y / 2, w}, {x - w, y, height - w}, back);
  const float in = w + (mounted ? 0.14f * std::min(width, height) : 0);
  const auto shown = craft.print(mesh, width - 2 * in, height - 2 * in,
                                 photograph(craft.split, craft.random.bits()));
  add_front_print(mesh, -x + in, x - in, in, height - in, -y / 2, shown);
}

void picture(Craft& craft, MadeModel& model) {
  const bool upright = craft.one_in(2);
  const float a = craft.between(0.25f, 0.5f), b = craft.between(0.4f, 0.85f);
  framed(craft, model, {upright ? a : b, upright ? b : a});
}

/// A frame that leans on what is behind it.
void leaning_picture(Craft& craft, MadeModel& model) {
  framed(craft, model, {craft.between(0.3f, 0.6f), craft.between(0.4f, 0.8f)});
  const float lean = craft.between(0.1f, 0.2f);
  model.mesh =
      moved(model.mesh, Eigen::Affine3f(Eigen::AngleAxisf(-lean, Eigen::Vector3f::UnitX())));
}

void photo_stand(Craft& craft, MadeModel& model) {
  const bool upright = craft.one_in(2);
  framed(craft, model, {upright ? 0.13f : 0.18f, upright ? 0.18f : 0.13f});
  model.mesh = moved(model.mesh, Eigen::Affine3f(Eigen::AngleAxisf(-craft.between(0.15f, 0.3f),
                                                                   Eigen::Vector3f::UnitX())));
  const auto leg = craft.metal(model.mesh);
  add_bar(model.mesh, Points{{0, 0.02f, 0.09f}, {0, 0.07f, 0.004f}}, 0.004f, leg);
}

void screen_of(Craft& craft, TexturedMesh& mesh, float x, float low, float high, bool on) {
  const auto body = craft.plastic(mesh);
  add_rounded_box(mesh, {-x, -0.02f, low}, {x, 0.02f, high}, 0.006f, body);
  const auto shown = on ? craft.print(mesh, 2 * x, high - low,
                                      screen_picture(craft.split, craft.random.bits()), kScreenGlow)
                        : craft.plain(mesh, {0.03f, 0.03f, 0.035f});
  add_front_print(mesh, -x + 0.012f, x - 0.012f, low + 0.018f, high - 0.012f, -0.02f, shown);
}

void tv(Craft& craft, MadeModel& model) {
  const float x = craft.between(0.45f, 0.65f), foot = 0.07f;
  screen_of(craft, model.mesh, x, foot, foot + 1.14f * x, !craft.one_in(3));
  const auto body = craft.plastic(model.mesh);
  if (craft.tuned()) {
    for (const float side : {-0.6f, 0.6f})
      add_bar(model.mesh,
              Points{{side * x, -0.1f, 0.006f}, {side * x, 0, foot}, {side * x, 0.1f, 0.006f}},
              0.006f, body);
  } else {
    add_board(model.mesh, {-0.2f, -0.1f, 0}, {0.2f, 0.1f, 0.012f}, body);
    add_board(model.mesh, {-0.05f, -0.015f, 0.01f}, {0.05f, 0.015f, foot + 0.02f}, body);
  }
}

void monitor(Craft& craft, MadeModel& model) {
  const float x = craft.between(0.24f, 0.34f), low = craft.between(0.1f, 0.16f);
  screen_of(craft, model.mesh, x, low, low + 1.12f * x, !craft.one_in(5));
  const auto stand = craft.plastic(model.mesh);
  if (craft.tuned())
    add_turned(model.mesh, {0, 0.03f, 0}, Profile{{0.12f, 0}, {0.12f, 0.01f}, {0.02f, 0.016f}},
               stand);
  else
    add_rounded_box(model.mesh, {-0.12f, -0.07f, 0}, {0.12f, 0.12f, 0.012f}, 0.005f, stand);
  add_bar(model.mesh, Points{{0, 0.03f, 0.01f}, {0, 0.03f, low + 0.1f}}, 0.018f, stand);
}

void laptop(Craft& craft, MadeModel& model) {
  TexturedMesh& mesh = model.mesh;
  const auto body = craft.one_in(2) ? craft.metal(mesh) : craft.plastic(mesh);
  const float x = craft.between(0.15f, 0.18f), y = craft.between(0.1f, 0.125f),
              tilt = craft.between(0.15f, 0.45f);
  add_rounded_box(mesh, {-x, -y, 0}, {x, y, 0.016f}, 0.004f, body);
  const PaintColor dark = PaintColor::Constant(0.08f),
                   light = PaintColor::Constant(craft.between(0.5f, 0.75f));
  const auto keys = craft.print(mesh, 0.5f, 0.25f,
                                key_rows(14, 5, craft.tuned() ? dark : light,
                                         craft.tuned() ? light : dark, craft.random.bits()));
  add_top_print(mesh, {-x + 0.02f, -y + 0.085f}, {x - 0.02f, y - 0.015f}, 0.016f, keys);
  const auto pad = craft.plain(mesh, PaintColor::Constant(0.4f));
  add_top_print(mesh, {-0.05f, -y + 0.012f}, {0.05f, -y + 0.075f}, 0.016f, pad);
  TexturedMesh lid;
  screen_of(craft, lid, x, 0, 2 * y - 0.01f, true);
  lid = moved(lid, Eigen::Affine3f(Eigen::Translation3f(0, y, 0.014f) *
                                   Eigen::AngleAxisf(-tilt, Eigen::Vector3f::UnitX()) *
                                   Eigen::Scaling(Eigen::Vector3f(1, 0.25f, 1))));
  add_mesh(mesh, lid);
}

}  // namespace

void add_pictures(Makers& makers) {
  makers["picture"] = {"picture", picture};
  makers["leaning picture"] = {"picture", leaning_picture};
  makers["photo stand"] = {"photo frame", photo_stand};
  makers["tv"] = {"tv", tv};
  makers["monitor"] = {"monitor", monitor};
  makers["laptop"] = {"laptop", laptop};
}

}  // namespace ovimap
