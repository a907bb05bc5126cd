// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/shapes/random.h"

#include <cmath>

namespace ovimap {

float Random::normal() {
  for (;;) {
    const float x = uniform(-1, 1), y = uniform(-1, 1);
    const float square = x * x + y * y;
    if (square > 0 && square < 1) return x * std::sqrt(-2 * std::log(square) / square);
  }
}

}  // namespace ovimap
