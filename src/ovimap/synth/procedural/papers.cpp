// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <vector>

#include "ovimap/synth/procedural/makers.h"
#include "ovimap/synth/procedural/prints.h"

namespace ovimap {
namespace {

using Points = std::vector<Eigen::Vector3f>;

struct Sheet {
  Eigen::Vector3f size;  ///< half width, half depth, height
  Paint paint;           ///< of the upper side
};

void flat_sheet(Craft& craft, MadeModel& model, const Sheet& sheet) {
  const float x = sheet.size.x(), y = sheet.size.y(), height = sheet.size.z();
  TexturedMesh& mesh = model.mesh;
  const auto edge = craft.plain(mesh, PaintColor::Constant(0.9f));
  add_board(mesh, {-x, -y, 0}, {x, y, height}, edge);
  add_top_print(mesh, {-x, -y}, {x, y}, height, craft.print(mesh, 2 * x, 2 * y, sheet.paint));
  model.stackable = true;
}

/// A sheet or a small pile, of office size.
void paper(Craft& craft, MadeModel& model) {
  const bool letter = !craft.tuned();
  flat_sheet(craft, model,
             {{letter ? 0.108f : 0.105f, letter ? 0.14f : 0.1485f,
               craft.one_in(2) ? 0.001f : craft.between(0.002f, 0.012f)},
              printed_page(craft.split, craft.random.bits())});
}
void envelope(Craft& craft, MadeModel& model) {
  const std::uint64_t seed = craft.random.bits();
  const PaintColor ground{craft.between(0.75f, 0.95f), craft.between(0.7f, 0.93f),
                          craft.between(0.6f, 0.92f)};
  const Paint lines = printed_page(craft.split, seed);
  flat_sheet(craft, model,
             {{0.11f, craft.between(0.055f, 0.08f), 0.002f}, [ground, lines](float x, float y) {
                if (x > 0.84f && x < 0.96f && y < 0.3f && y > 0.08f)
                  return PaintColor(0.7f, 0.3f, 0.3f);
                return x > 0.4f && x < 0.75f && y > 0.45f && y < 0.75f
                           ? PaintColor(lines(x, 0.2f + 0.3f * y).cwiseProduct(ground))
                           : ground;
              }});
}
void magazine(Craft& craft, MadeModel& model) {
  flat_sheet(
      craft, model,
      {{craft.between(0.1f, 0.11f), craft.between(0.13f, 0.15f), craft.between(0.003f, 0.008f)},
       cover(craft.split, craft.random.bits())});
}
void folder(Craft& craft, MadeModel& model) {
  const PaintColor ground{craft.between(0.1f, 0.9f), craft.between(0.1f, 0.9f),
                          craft.between(0.1f, 0.9f)};
  flat_sheet(craft, model,
             {{0.12f, 0.158f, craft.between(0.004f, 0.02f)}, [ground](float x, float y) {
                return x > 0.6f && x < 0.9f && y > 0.08f && y < 0.14f
                           ? PaintColor(0.93f, 0.93f, 0.9f)
                           : ground;
              }});
}
void card(Craft& craft, MadeModel& model) {
  flat_sheet(craft, model, {{0.043f, 0.027f, 0.0012f}, cover(craft.split, craft.random.bits())});
}
void photo_print(Craft& craft, MadeModel& model) {
  flat_sheet(craft, model,
             {{0.075f, 0.05f, 0.0012f}, photograph(craft.split, craft.random.bits())});
}
void sticky_notes(Craft& craft, MadeModel& model) {
  const PaintColor ground{craft.between(0.85f, 1), craft.between(0.6f, 0.95f),
                          craft.between(0.2f, 0.6f)};
  flat_sheet(
      craft, model,
      {{0.038f, 0.038f, craft.between(0.004f, 0.012f)}, [ground](float, float) { return ground; }});
}
void mouse_pad(Craft& craft, MadeModel& model) {
  const Paint shown = photograph(craft.split, craft.random.bits());
  const PaintColor plain = PaintColor::Constant(craft.between(0.08f, 0.4f));
  const bool printed = craft.one_in(2);
  flat_sheet(craft, model,
             {{craft.between(0.1f, 0.13f), craft.between(0.09f, 0.11f), 0.003f},
              [=](float x, float y) { return printed ? shown(x, y) : plain; }});
}
void place_mat(Craft& craft, MadeModel& model) {
  const std::uint64_t seed = craft.random.bits();
  flat_sheet(craft, model, {{0.2f, 0.15f, 0.003f}, rug_motif(craft.split, 1.2f, 0.9f, seed)});
}

/// Covers about a block of pages.
void book(Craft& craft, MadeModel& model) {
  TexturedMesh& mesh = model.mesh;
  const auto pages = craft.plain(mesh, {0.9f, 0.87f, 0.78f});
  const Paint front = cover(craft.split, craft.random.bits());
  const float x = craft.between(0.06f, 0.11f), y = x * craft.between(1.3f, 1.5f),
              h = craft.between(0.012f, 0.045f), board = 0.002f;
  const auto shown = craft.print(mesh, 2 * x, 2 * y, front),
             cloth = craft.plain(mesh, front(0.02f, 0.02f));
  add_board(mesh, {-x + 0.004f, -y + 0.004f, board}, {x - 0.004f, y - 0.004f, h - board}, pages);
  for (const float low : {0.f, h - board})
    add_board(mesh, {-x, -y, low}, {x, y, low + board}, cloth);
  add_board(mesh, {-x - 0.002f, -y, 0}, {-x + 0.002f, y, h}, cloth);
  add_top_print(mesh, {-x, -y}, {x, y}, h, shown);
  model.stackable = true;
}

/// A book that stands, its spine to the front.
void standing_book(Craft& craft, MadeModel& model) {
  TexturedMesh& mesh = model.mesh;
  const auto pages = craft.plain(mesh, {0.9f, 0.87f, 0.78f});
  const Paint spine = cover(craft.split, craft.random.bits());
  const auto cloth = craft.plain(mesh, spine(0.5f, 0.02f));
  const float x = craft.between(0.008f, 0.026f), y = craft.between(0.07f, 0.1f),
              h = craft.between(0.18f, 0.28f);
  add_board(mesh, {-x + 0.002f, -y + 0.002f, 0.003f}, {x - 0.002f, y - 0.003f, h - 0.003f}, pages);
  for (const float side : {-x, x - 0.002f})
    add_board(mesh, {side, -y, 0}, {side + 0.002f, y, h}, cloth);
  add_board(mesh, {-x, -y - 0.002f, 0}, {x, -y, h}, cloth);
  add_front_print(mesh, -x, x, 0, h, -y - 0.002f, craft.print(mesh, 2 * x, h, spine));
}

/// Rings along one side, ruled or written pages.
void notebook(Craft& craft, MadeModel& model) {
  const bool open = craft.one_in(2);
  flat_sheet(craft, model,
             {{open ? 0.15f : 0.075f, 0.105f, craft.between(0.006f, 0.015f)},
              open ? printed_page(craft.split, craft.random.bits())
                   : cover(craft.split, craft.random.bits())});
  const Eigen::AlignedBox3f box = bounds(model.mesh);
  const auto wire = craft.metal(model.mesh);
  for (int i = 0; i < 12; ++i) {
    const float y = box.min().y() + 0.012f + 0.0165f * static_cast<float>(i),
                x = open ? 0.f : box.min().x();
    add_bar(model.mesh,
            Points{{x - 0.006f, y, box.max().z() * 0.6f},
                   {x, y, box.max().z() + 0.004f},
                   {x + 0.006f, y, box.max().z() * 0.9f}},
            0.0012f, wire);
  }
  model.stackable = false;
}

void ruler(Craft& craft, MadeModel& model) {
  const PaintColor ground{craft.between(0.6f, 0.95f), craft.between(0.6f, 0.9f),
                          craft.between(0.3f, 0.9f)};
  flat_sheet(craft, model,
             {{craft.tuned() ? 0.155f : 0.105f, 0.017f, 0.003f}, [ground](float x, float y) {
                return y < 0.35f && part_of(x * 60) < 0.35f ? PaintColor(0.1f, 0.1f, 0.1f) : ground;
              }});
  model.stackable = false;
}

}  // namespace

void add_papers(Makers& makers) {
  makers["mouse pad"] = {"mouse pad", mouse_pad};
  makers["paper"] = {"paper", paper};
  makers["envelope"] = {"paper", envelope};
  makers["folder"] = {"folder", folder};
  makers["magazine"] = {"magazine", magazine};
  makers["card"] = {"paper", card};
  makers["photo print"] = {"paper", photo_print};
  makers["sticky notes"] = {"paper", sticky_notes};
  makers["place mat"] = {"place mat", place_mat};
  makers["book"] = {"book", book};
  makers["standing book"] = {"book", standing_book};
  makers["notebook"] = {"notebook", notebook};
  makers["ruler"] = {"ruler", ruler};
}

}  // namespace ovimap
