// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <string>

namespace ovimap {

/// "12 %" of 0.12.
inline std::string percent_text(float share) {
  char text[16];
  std::snprintf(text, sizeof text, "%.0f %%", 100. * double{share});
  return text;
}

}  // namespace ovimap
