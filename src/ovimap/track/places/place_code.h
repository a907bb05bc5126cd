// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "ovimap/track/images/track_pyramid.h"

namespace ovimap {

inline constexpr int kCodeWidth = 20, kCodeHeight = 15;
inline constexpr std::size_t kCodePixels = std::size_t{kCodeWidth} * kCodeHeight;

/// What a place looks like from one pose: its intensities and inverse depths as images of a few
/// hundred pixels, each with mean 0 and length 1. Two codes compare by the product of their pixels,
/// so a change of exposure does not matter, and no index is needed for thousands. It needs no
/// training and no chance, unlike ferns and vocabularies, and depth tells white rooms apart.
struct PlaceCode {
  std::array<float, kCodePixels> intensity{}, inverse_depth{};
};

PlaceCode place_code(const TrackPyramid& pyramid);

/// -1 to 1: the mean of both correlations, at the shift of at most two pixels at which the
/// intensities fit best.
double similarity(const PlaceCode& a, const PlaceCode& b);

/// The most similar of `codes` to `code`, best first, at most `count`, each at least
/// `min_similarity`.
std::vector<std::size_t> most_similar(const PlaceCode& code, const std::vector<PlaceCode>& codes,
                                      std::size_t count, double min_similarity);

/// A rotation that lays `frame` over `reference`, both taken from one place: the shift of their
/// coarsest images at which intensities differ least. For a camera that turns too fast for
/// a prediction from its last motion.
Pose turn_between(const TrackPyramid& reference, const TrackPyramid& frame);

}  // namespace ovimap
