// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "ovimap/semantics/relations/object_shape.h"

namespace ovimap {

/// How large an object is and where, in metres.
struct ObjectMeasures {
  float height_m = 0;
  float length_m = 0, depth_m = 0;  ///< sides of the smallest upright box around it
  float bottom_m = 0;               ///< above the floor
};

/// Without the 5 % of the surface that lie farthest out at each end, which often are not its own.
/// The floor is where 2 % of all surface is lower. All shapes in one ground frame.
std::vector<ObjectMeasures> measure_objects(std::span<const ObjectShape> shapes);

/// How large things of a name usually are, and between which heights their bottoms are.
struct ThingSize {
  std::string word;
  ObjectMeasures usual;  ///< bottom_m: the lowest
  float highest_bottom_m = 0;
};

/// Lines "word;height;length;depth;bottom from;bottom to" in metres. Throws Error for others.
std::vector<ThingSize> read_thing_sizes(const std::vector<std::string>& lines);

/// How well an object's measures fit a thing's, up to a factor that is the same for all things: a
/// normal distribution of each logarithm, wider below than above the usual, since objects are seen
/// in part, and of the distance to the usual heights. No side alone can rule a thing out.
float size_likelihood(const ObjectMeasures& object, const ThingSize& thing);

}  // namespace ovimap
