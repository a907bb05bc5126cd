// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/pictures/pictures_scale_bar.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>

#include "ovimap/base/error.h"

namespace ovimap {

namespace {

constexpr Rgb8 kInk = {40, 40, 40};
constexpr int kGlyphWidth = 5, kGlyphHeight = 5;

struct Glyph {
  char symbol;
  std::array<std::string_view, kGlyphHeight> rows;
};

constexpr std::array<Glyph, 6> kGlyphs = {{
    {'0', {" ### ", "#   #", "#   #", "#   #", " ### "}},
    {'1', {"  #  ", " ##  ", "  #  ", "  #  ", " ### "}},
    {'2', {"#### ", "    #", " ### ", "#    ", "#####"}},
    {'5', {"#####", "#    ", "#### ", "    #", "#### "}},
    {'m', {"     ", "## # ", "# # #", "# # #", "# # #"}},
    {'.', {"     ", "     ", "     ", "     ", "  #  "}},
}};

void fill(RgbImage& image, int left, int top, int width, int height) {
  for (int y = std::max(top, 0); y < std::min(top + height, image.height()); ++y)
    for (int x = std::max(left, 0); x < std::min(left + width, image.width()); ++x)
      image.at(x, y) = kInk;
}

void write(RgbImage& image, const std::string& text, int left, int top, int dot) {
  for (const char symbol : text) {
    for (const Glyph& glyph : kGlyphs)
      for (int y = 0; glyph.symbol == symbol && y < kGlyphHeight; ++y)
        for (int x = 0; x < kGlyphWidth; ++x)
          if (glyph.rows[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)] == '#')
            fill(image, left + x * dot, top + y * dot, dot, dot);
    left += (symbol == ' ' ? 3 : kGlyphWidth + 1) * dot;
  }
}

}  // namespace

float scale_bar_length_m(int image_width_px, float px_per_m) {
  const float most_m = static_cast<float>(image_width_px) / 5 / px_per_m;
  const float decade = std::pow(10.f, std::floor(std::log10(most_m)));
  for (const float times : {5.f, 2.f})
    if (times * decade <= most_m) return times * decade;
  return decade;
}

void draw_scale_bar(RgbImage& image, float px_per_m) {
  const float length_m = scale_bar_length_m(image.width(), px_per_m);
  const int dot = std::max(1, image.width() / 500);
  const int margin = 8 * dot, thickness = 2 * dot, tick = 5 * dot;
  const int length = static_cast<int>(std::lround(length_m * px_per_m));
  const int bottom = image.height() - margin;
  fill(image, margin, bottom - thickness, length, thickness);
  fill(image, margin, bottom - tick, thickness, tick);
  fill(image, margin + length - thickness, bottom - tick, thickness, tick);
  write(image, concat(length_m, " m"), margin, bottom - tick - (kGlyphHeight + 2) * dot, dot);
}

}  // namespace ovimap
