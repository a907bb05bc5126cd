// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "ovimap/instance/instance_registry.h"
#include "ovimap/semantics/relations/object_shape.h"

namespace ovimap {

class ConfigFields;

/// What one object is to another. kNearest and kFarthest compare several objects, kBetween needs
/// two anchors, kPartOf is known (ObjectPart) and not judged; the others hold or not for a pair
/// alone.
enum class Relation {
  kOn,
  kUnder,
  kAbove,
  kBeside,
  kNear,
  kInside,
  kBetween,
  kNearest,
  kFarthest,
  kLeftOf,
  kRightOf,
  kInFrontOf,
  kBehind,
  kPartOf  ///< a drawer of a cabinet: parts of objects are looked for, not objects
};

enum class Superlative { kLargest, kSmallest, kTallest, kShortest, kHighest, kLowest };

/// Distances at which a relation is half true; it fades over about half to twice of them.
struct RelationConfig {
  float contact_m = 0.05f;    ///< on: between bottom and support, or picture and wall
  float beside_m = 0.5f;      ///< beside: gap
  float near_m = 1.0f;        ///< near: gap
  float side_reach_m = 3.0f;  ///< left of, right of, in front of, behind: gap
  float overhang_m = 0.3f;    ///< above, under: horizontal gap, as of a picture above a sofa
  float flat_share = 0.34f;   ///< a thing thinner than this share of its size can hang on a wall
};
void list_fields(RelationConfig& config, ConfigFields& fields);

/// Where left and right are seen from. Ground frame, metres.
struct GroundViewpoint {
  Eigen::Vector2f position = Eigen::Vector2f::Zero();
  Eigen::Vector2f forward = Eigen::Vector2f::UnitX();  ///< counts where an anchor is at `position`
};

constexpr float kRelationHolds = 0.5f;  ///< from this rating on

struct RelationRating {
  float score = 0;       ///< 0 does not hold, 1 holds, 0.5 on the border
  std::string evidence;  ///< a clause: "0.02 m above the top of #12"
};

/// How true "a RELATION b" is; any pair relation. `id_b` is what the evidence calls b.
RelationRating rate_relation(Relation relation, const ObjectShape& a, const ObjectShape& b,
                             InstanceId id_b, const GroundViewpoint& viewpoint,
                             const RelationConfig& config);

/// No rating of "a RELATION b" is higher, where all that is known of them are their upright boxes:
/// what spares distant pairs the search for their nearest points.
float highest_rating(Relation relation, const Eigen::AlignedBox3f& box_a,
                     const Eigen::AlignedBox3f& box_b, const RelationConfig& config);

/// How true "a is between b and c" is: by the angle under which a sees their nearest points.
RelationRating rate_between(const ObjectShape& a, const ObjectShape& b, const ObjectShape& c,
                            InstanceId id_b, InstanceId id_c);

/// What a superlative compares; the highest value wins. `evidence` says it.
struct SuperlativeMeasure {
  float value = 0;
  std::string evidence;
};
SuperlativeMeasure measure(Superlative superlative, const ObjectShape& shape);

}  // namespace ovimap
