// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "ovimap/synth/procedural/made_model.h"
#include "ovimap/synth/shapes/painting.h"

namespace ovimap {

/// What is printed on things, shown by screens and hung on walls; all painted from a seed, other
/// motifs for each split.
Paint photograph(Split split, std::uint64_t seed);
/// What is seen through a window: land or a street.
Paint view_outside(Split split, std::uint64_t seed);
/// Windows, text and a photograph, or a picture that fills the screen.
Paint screen_picture(Split split, std::uint64_t seed);
/// Lines of text with headings, sometimes a figure.
Paint printed_page(Split split, std::uint64_t seed);
/// Of a book, a magazine, a box of tea.
Paint cover(Split split, std::uint64_t seed);
/// Keys in rows.
Paint key_rows(int columns, int rows, const PaintColor& keys, const PaintColor& ground,
               std::uint64_t seed);
Paint rug_motif(Split split, float width_m, float depth_m, std::uint64_t seed);

}  // namespace ovimap
