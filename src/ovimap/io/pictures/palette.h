// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ovimap/image/image.h"

namespace ovimap {

/// The colour of an instance, everywhere: pictures, PLY files, the viewer. It depends on the id
/// alone, so it stays when other instances come and go. Id 0 (no instance) is grey; other ids walk
/// in even steps, irrational to each other, through hue, lightness and chroma of OKLCH, where equal
/// distances look equally different. The first 40 are pairwise at least 0.055 apart in OKLab.
Rgb8 instance_color(std::uint32_t id);

/// The colours of many vertices at once.
std::vector<std::array<std::uint8_t, 3>> instance_colors(std::span<const std::uint32_t> ids);

/// From dark blue (0) over purple and orange to pale yellow (1); what is beyond counts as the end.
/// Lightness rises evenly, so that the order survives print and colour blindness.
Rgb8 heat_color(float share);

}  // namespace ovimap
