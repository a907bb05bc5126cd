// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "ovimap/synth/shapes/random.h"
#include "ovimap/synth/shapes/texture.h"

namespace ovimap {

/// Which half of a benchmark a thing may appear in. The halves share no shape, no print and no
/// weave: parameters are tuned on the one, results are reported on the other.
enum class Split { kTuned, kUnseen };

/// A level surface that things can stand on, in the frame of the model that has it.
struct Deck {
  Eigen::Vector2f center_m = Eigen::Vector2f::Zero(), half_m = Eigen::Vector2f::Zero();
  float height_m = 0;
  float clearance_m = 10;  ///< free space above it
};

/// A thing made by rule, in its own frame as a furniture model: metres, z up, front -y, the middle
/// of its base at the origin.
struct MadeModel {
  std::string name;        ///< "corner sofa"
  std::string class_name;  ///< one of room_classes
  TexturedMesh mesh;
  std::vector<Deck> decks;
  bool stackable = false;  ///< its upper side is level: other things may lie on it
  bool soft = false;       ///< sinks into uneven ground
  float glow = 0;          ///< how much light its shade gives; 0: none
};

/// The kinds that can be made, in alphabetical order.
std::vector<std::string> made_kinds();

/// A thing of the kind: each call another one, in shape, size, texture and colour. Throws Error for
/// an unknown kind, with the nearest known one.
MadeModel make_model(const std::string& kind, Split split, Random& random);

}  // namespace ovimap
