// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// The contact sheet of pictures.h.
#include <algorithm>
#include <cmath>

#include "ovimap/base/config.h"
#include "ovimap/base/error.h"
#include "ovimap/image/resize.h"
#include "ovimap/io/pictures/palette.h"
#include "ovimap/io/pictures/pictures.h"

namespace ovimap {

namespace {

constexpr Rgb8 kSheetGround = {247, 247, 244};

Rgb8 blended(Rgb8 under, Rgb8 over, float opacity) {
  const auto mix = [opacity](std::uint8_t a, std::uint8_t b) {
    return static_cast<std::uint8_t>(
        std::lround(static_cast<float>(a) * (1 - opacity) + static_cast<float>(b) * opacity));
  };
  return {mix(under.r, over.r), mix(under.g, over.g), mix(under.b, over.b)};
}

/// Whether the neighbour to the right or below has another id.
bool on_boundary(const IdImage& ids, int x, int y) {
  const std::uint16_t id = ids.at(x, y);
  return (x + 1 < ids.width() && ids.at(x + 1, y) != id) ||
         (y + 1 < ids.height() && ids.at(x, y + 1) != id);
}

void paste(const RgbImage& tile, int left, int top, RgbImage& sheet) {
  for (int y = 0; y < tile.height(); ++y)
    std::copy_n(tile.row(y), tile.width(), sheet.row(top + y) + left);
}

}  // namespace

void list_fields(SheetConfig& config, ConfigFields& fields) {
  fields.add("columns", config.columns, 1, 100, "frames side by side on a contact sheet");
  fields.add("tile_width_px", config.tile_width_px, 8, 4000,
             "width of one image on a contact sheet, in pixels");
  fields.add("gap_px", config.gap_px, 0, 100, "space between images on a contact sheet, in pixels");
  fields.add("opacity", config.opacity, 0.f, 1.f, "how much the instance colours cover the image");
}

RgbImage overlay(const RgbImage& color, const IdImage& ids, float opacity) {
  OVIMAP_ASSERT(color.same_size(ids));
  RgbImage result = color;
  std::uint16_t known_id = 0;
  Rgb8 known_color;
  for (int y = 0; y < color.height(); ++y)
    for (int x = 0; x < color.width(); ++x) {
      const std::uint16_t id = ids.at(x, y);
      if (id == 0) continue;
      if (id != known_id) known_id = id, known_color = instance_color(id);
      result.at(x, y) =
          blended(color.at(x, y), known_color, on_boundary(ids, x, y) ? 1.f : opacity);
    }
  return result;
}

RgbImage contact_sheet(std::span<const SheetFrame> frames, const SheetConfig& config) {
  const auto tile_height = [&](const SheetFrame& frame) {
    return std::max(1,
                    config.tile_width_px * frame.color.height() / std::max(1, frame.color.width()));
  };
  int row_height = 1;
  for (const SheetFrame& frame : frames) row_height = std::max(row_height, tile_height(frame));
  const int columns = std::clamp(static_cast<int>(frames.size()), 1, config.columns);
  const int rows = (static_cast<int>(frames.size()) + columns - 1) / columns;
  const int cell_width = 2 * config.tile_width_px + config.gap_px,
            cell_height = row_height + config.gap_px;
  RgbImage sheet(columns * cell_width + config.gap_px, rows * cell_height + config.gap_px,
                 kSheetGround);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (frames[i].color.empty()) continue;
    const int height = tile_height(frames[i]);
    const int left = static_cast<int>(i) % columns * cell_width + config.gap_px;
    const int top = static_cast<int>(i) / columns * cell_height + config.gap_px;
    // Ids are shrunk before they are drawn, so that boundaries stay one pixel wide.
    const RgbImage color = resize_bilinear(frames[i].color, config.tile_width_px, height);
    const IdImage ids = resize_nearest(frames[i].ids, config.tile_width_px, height);
    paste(color, left, top, sheet);
    paste(overlay(color, ids, config.opacity), left + config.tile_width_px, top, sheet);
  }
  return sheet;
}

}  // namespace ovimap
