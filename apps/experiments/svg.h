// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include "ovimap/base/error.h"

namespace ovimap::apps {

// Wong, "Points of view: Color blindness", Nature Methods 8, 2011.
inline constexpr std::array kSvgColors = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                          "#e69f00", "#56b4e9", "#f0e442", "#000000"};

/// "12.3"; "-" for what is not finite.
inline std::string one_decimal(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", value);
  return std::isfinite(value) ? text : "-";
}

struct Point {
  double x = 0, y = 0;  ///< units of the picture, y downwards
};

inline std::string svg_text(Point at, const std::string& text, const char* anchor = "middle") {
  std::string escaped;
  for (const char c : text)
    escaped += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
  return concat("<text x=\"", at.x, "\" y=\"", at.y, "\" text-anchor=\"", anchor, "\">", escaped,
                "</text>\n");
}

}  // namespace ovimap::apps
