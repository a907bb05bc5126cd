// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "ovimap/image/image.h"

namespace ovimap {

/// A drawn picture and what it shows.
struct Drawing {
  std::string name;
  RgbImage picture;
};

/// Pictures of one colour each.
std::vector<Drawing> drawn_colours();
/// Black on white: circle, square, triangle, cross.
std::vector<Drawing> drawn_shapes();
/// A red disc of `radius_px` in the middle of a grey picture.
RgbImage drawn_disc(int width_px, int height_px, int radius_px);

}  // namespace ovimap
