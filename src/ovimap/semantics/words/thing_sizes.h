// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "ovimap/semantics/relations/object_measures.h"

namespace ovimap {

/// Measures in units by which things of a name differ: logarithms of height, length and depth, the
/// heights of bottom and top, then top share and covered share.
using StandardMeasures = Eigen::Array<float, 7, 1>;
StandardMeasures standard_measures(const ObjectMeasures& measures);

/// One way that maps showed a thing: whole, or its top alone, or in part.
struct SeenSize {
  StandardMeasures measures;
  float share = 0;  ///< of all that was seen of the thing
};

/// How large things of a name are, and between which heights their bottoms are.
struct ThingSize {
  std::string word;
  ObjectMeasures usual;  ///< bottom_m: the lowest; no length: not known
  float highest_bottom_m = 0;
  std::vector<SeenSize> seen;  ///< shares sum to 1; empty: none
};

/// `usual`: lines "word;height;length;depth;bottom from;bottom to"; `seen`: lines
/// "word;height;length;depth;bottom;top share;covered share;count", of a word as many as there are
/// ways to see it. Metres. Throws Error for others.
std::vector<ThingSize> read_thing_sizes(const std::vector<std::string>& usual,
                                        const std::vector<std::string>& seen);

/// Those that are compiled in: data/thing_sizes.txt and data/seen_sizes.txt.
const std::vector<ThingSize>& builtin_thing_sizes();

/// [things] How well an object's measures fit each thing's, up to a factor that is the same for
/// all: the mean of what fits each way that maps showed it in (a kernel density) and, as one way
/// more since rooms hold more than was rendered, of what is usual: a normal distribution of each
/// logarithm, wider below than above, since objects are seen in part, and of the distances to the
/// usual heights of bottom and top, half of each, since the lower half is often hidden; how its
/// surface is spread counts there as it does for the mean of all seen. No single measure can rule a
/// thing out.
std::vector<float> size_likelihoods(const ObjectMeasures& object,
                                    std::span<const ThingSize> things);

}  // namespace ovimap
