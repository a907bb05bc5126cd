// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/relations/relations.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "ovimap/base/config.h"

namespace ovimap {

namespace {

/// 1 at a gap of 0, 0.5 at `scale`, 0.06 at twice of it.
float closeness(float gap, float scale) {
  const float ratio2 = gap * gap / (scale * scale);
  return 1.f / (1.f + ratio2 * ratio2);
}

/// 0 at -scale and below, 0.5 at 0, 1 at scale and above.
float ramp(float value, float scale) {
  return std::clamp(0.5f + 0.5f * value / scale, 0.f, 1.f);
}

/// Half of something is enough.
float mostly(float share) {
  return std::min(1.f, 2.f * share);
}

std::string metres(float value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f m", double{value});
  return text;
}

std::string name_of(InstanceId id) {
  return "#" + std::to_string(id);  // quicker than a stream, and asked for every pair
}

/// Of the smaller footprint.
float footprint_share(const ObjectShape& a, const ObjectShape& b) {
  return overlap_m2(a.footprint, b.footprint) /
         std::min(area_m2(a.footprint), area_m2(b.footprint));
}

/// Of the lower object's height.
float height_share(const ObjectShape& a, const ObjectShape& b) {
  const float shared = std::min(a.top_m, b.top_m) - std::max(a.bottom_m, b.bottom_m);
  return std::max(shared, 0.f) / std::min(a.height_m(), b.height_m());
}

RelationRating rests_on(const ObjectShape& a, const ObjectShape& b, InstanceId id,
                        const RelationConfig& config) {
  const float support = support_height_m(a, b, config.contact_m);
  if (support == std::numeric_limits<float>::lowest()) return {0.f, "not over " + name_of(id)};
  const float gap = a.bottom_m - support;
  const float covered = overlap_m2(a.footprint, b.footprint) / area_m2(a.footprint);
  const char* part = b.top_m - support > config.contact_m ? " a part of " : " the top of ";
  const std::string height = gap < 0.f ? metres(-gap) + " lower than" : metres(gap) + " above";
  return {closeness(gap, config.contact_m) * mostly(covered), height + part + name_of(id)};
}

/// A flat thing against the side of a taller one, off its foot.
RelationRating hangs_on(const ObjectShape& a, const ObjectShape& b, InstanceId id,
                        const RelationConfig& config) {
  const float inside = std::min(a.bottom_m - b.bottom_m, b.top_m - a.top_m);
  const float off_foot = ramp(inside - config.contact_m, config.contact_m);
  if (off_foot == 0.f) return {};
  const float size = std::max(a.height_m(), 0.5f * perimeter_m(a.footprint));
  if (smallest_width_m(a.footprint) > config.flat_share * size) return {};
  const float gap = gap_m(a, b);
  return {closeness(gap, config.contact_m) * off_foot,
          metres(gap) + " from the side of " + name_of(id)};
}

RelationRating rate_on(const ObjectShape& a, const ObjectShape& b, InstanceId id,
                       const RelationConfig& config) {
  const RelationRating rests = rests_on(a, b, id, config), hangs = hangs_on(a, b, id, config);
  return hangs.score > rests.score ? hangs : rests;
}

RelationRating rate_above(const ObjectShape& a, const ObjectShape& b, InstanceId id,
                          const RelationConfig& config) {
  const float clearance = a.bottom_m - b.top_m;
  const float aside = distance_m(a.footprint, b.footprint);
  const float over = std::max(mostly(footprint_share(a, b)), closeness(aside, config.overhang_m));
  if (clearance < 0.f)
    return {ramp(clearance, config.contact_m) * over,
            "begins " + metres(-clearance) + " below the top of " + name_of(id)};
  return {ramp(clearance, config.contact_m) * over, metres(clearance) + " above " + name_of(id)};
}

RelationRating rate_under(const ObjectShape& a, const ObjectShape& b, InstanceId id,
                          const RelationConfig& config) {
  // Clear of it, as a cabinet under a window ...
  const float clear = rate_above(b, a, id, config).score;
  // ... or among its legs, as a box under a table.
  const float lower = std::min(ramp(b.top_m - a.middle_m(), config.contact_m),
                               ramp(b.bottom_m + config.contact_m - a.bottom_m, config.contact_m));
  const float among = mostly(footprint_share(a, b)) * lower;
  const float clearance = b.bottom_m - a.top_m;
  if (clear >= among && clearance >= 0.f)
    return {clear, metres(clearance) + " below " + name_of(id)};
  return {std::max(clear, among),
          "its middle is " + metres(b.top_m - a.middle_m()) + " below the top of " + name_of(id)};
}

RelationRating rate_beside(const ObjectShape& a, const ObjectShape& b, InstanceId id,
                           const RelationConfig& config) {
  const float gap = gap_m(a, b);
  const float level = mostly(height_share(a, b)) * mostly(1.f - footprint_share(a, b));
  return {closeness(gap, config.beside_m) * level,
          level < 0.5f ? "not at the level of " + name_of(id)
                       : metres(gap) + " from the side of " + name_of(id)};
}

RelationRating rate_inside(const ObjectShape& a, const ObjectShape& b, InstanceId id) {
  const float flat = overlap_m2(a.footprint, b.footprint) / area_m2(a.footprint);
  const float tall = std::min(a.top_m, b.top_m) - std::max(a.bottom_m, b.bottom_m);
  const float share = flat * std::max(tall, 0.f) / a.height_m();
  return {share, concat(std::lround(100.f * share), " % of it within ", name_of(id))};
}

/// Left, right, in front, behind: the direction from the nearest point of b, as the viewer who
/// looks at b sees it.
RelationRating rate_side(Relation relation, const ObjectShape& a, const ObjectShape& b,
                         InstanceId id, const GroundViewpoint& viewpoint,
                         const RelationConfig& config) {
  constexpr float kNowhere = 1e-3f;  // metres; shorter vectors have no direction
  Eigen::Vector2f forward = b.centroid.head<2>() - viewpoint.position;
  if (forward.norm() < kNowhere) forward = viewpoint.forward;
  forward.normalize();
  const Eigen::Vector2f right(forward.y(), -forward.x());
  const Eigen::Vector2f from_b =
      a.centroid.head<2>() - nearest_point(b.footprint, a.centroid.head<2>());
  if (from_b.norm() < kNowhere) return {0.f, "over or under " + name_of(id)};

  const bool sideways = relation == Relation::kLeftOf || relation == Relation::kRightOf;
  const bool negative = relation == Relation::kLeftOf || relation == Relation::kInFrontOf;
  const float along = (negative ? -1.f : 1.f) * from_b.dot(sideways ? right : forward);
  const float cosine = std::max(along / from_b.norm(), 0.f);
  const char* side = sideways ? (negative ? " to the left of " : " to the right of ")
                              : (negative ? " in front of " : " behind ");
  const float shown = std::abs(along);
  const char* opposite = sideways ? (negative ? " to the right of " : " to the left of ")
                                  : (negative ? " behind " : " in front of ");
  // On another side it does not matter how far.
  const float near = cosine > 0.f ? closeness(gap_m(a, b), config.side_reach_m) : 0.f;
  return {cosine * cosine * near, metres(shown) + (along < 0.f ? opposite : side) + name_of(id)};
}

std::string evidence_of(const char* what, float value, const char* unit) {
  char text[64];
  std::snprintf(text, sizeof text, "%s %.2f %s", what, double{value}, unit);
  return text;
}

}  // namespace

void list_fields(RelationConfig& config, ConfigFields& fields) {
  constexpr float kLeast = 1e-3f, kMost = 100.f;
  fields.add("contact_m", config.contact_m, kLeast, kMost,
             "on: half true at this gap between a thing and its support, metres");
  fields.add("beside_m", config.beside_m, kLeast, kMost, "beside: half true at this gap, metres");
  fields.add("near_m", config.near_m, kLeast, kMost, "near: half true at this gap, metres");
  fields.add("side_reach_m", config.side_reach_m, kLeast, kMost,
             "left, right, in front, behind: half true at this gap, metres");
  fields.add("overhang_m", config.overhang_m, kLeast, kMost,
             "above, under: half true at this horizontal gap, metres");
  fields.add("flat_share", config.flat_share, 0.f, 1.f,
             "a thing thinner than this share of its size can hang on a wall");
}

RelationRating rate_relation(Relation relation, const ObjectShape& a, const ObjectShape& b,
                             InstanceId id_b, const GroundViewpoint& viewpoint,
                             const RelationConfig& config) {
  switch (relation) {
    case Relation::kOn:
      return rate_on(a, b, id_b, config);
    case Relation::kUnder:
      return rate_under(a, b, id_b, config);
    case Relation::kAbove:
      return rate_above(a, b, id_b, config);
    case Relation::kBeside:
      return rate_beside(a, b, id_b, config);
    case Relation::kInside:
      return rate_inside(a, b, id_b);
    case Relation::kLeftOf:
    case Relation::kRightOf:
    case Relation::kInFrontOf:
    case Relation::kBehind:
      return rate_side(relation, a, b, id_b, viewpoint, config);
    default: {
      const float gap = gap_m(a, b);
      return {closeness(gap, config.near_m), metres(gap) + " from " + name_of(id_b)};
    }
  }
}

float highest_rating(Relation relation, const Eigen::AlignedBox3f& box_a,
                     const Eigen::AlignedBox3f& box_b, const RelationConfig& config) {
  // Distances are summed in another order than those of a rating.
  constexpr float kRounding = 1.001f;
  const Eigen::Vector3f apart =
      (box_a.min() - box_b.max()).cwiseMax(box_b.min() - box_a.max()).cwiseMax(0.f);
  const auto bound = [](float gap, float scale) {
    return std::min(1.f, kRounding * closeness(gap, scale));
  };
  switch (relation) {
    case Relation::kOn: {
      // It rests on what it is over, or hangs at what reaches farther up and down (hangs_on).
      const bool over = apart.head<2>().norm() <= kRounding * config.contact_m;
      const float inside =
          std::min(box_a.min().z() - box_b.min().z(), box_b.max().z() - box_a.max().z());
      return std::max(over ? bound(apart.z(), config.contact_m) : 0.f,
                      bound(apart.norm(), config.contact_m) *
                          ramp(inside - config.contact_m, config.contact_m));
    }
    case Relation::kUnder:
    case Relation::kAbove:
      return bound(apart.head<2>().norm(), config.overhang_m);
    case Relation::kBeside:
      return bound(apart.norm(), config.beside_m);
    case Relation::kInside:
      return apart.isZero(0.f) ? 1.f : 0.f;
    case Relation::kLeftOf:
    case Relation::kRightOf:
    case Relation::kInFrontOf:
    case Relation::kBehind:
      return bound(apart.norm(), config.side_reach_m);
    default:
      return bound(apart.norm(), config.near_m);
  }
}

RelationRating rate_between(const ObjectShape& a, const ObjectShape& b, const ObjectShape& c,
                            InstanceId id_b, InstanceId id_c) {
  const Eigen::Vector2f at = a.centroid.head<2>();
  const Eigen::Vector2f to_b = nearest_point(b.footprint, at) - at;
  const Eigen::Vector2f to_c = nearest_point(c.footprint, at) - at;
  const float lengths = to_b.norm() * to_c.norm();
  if (lengths == 0.f) return {0.f, concat("over or under #", id_b, " or #", id_c)};
  const float facing = 0.5f * (1.f - to_b.dot(to_c) / lengths);  // 1: in opposite directions
  return {facing * facing, concat(metres(to_b.norm()), " from #", id_b, " and ",
                                  metres(to_c.norm()), " from #", id_c, " on the other side")};
}

SuperlativeMeasure measure(Superlative superlative, const ObjectShape& shape) {
  // Surface rather than volume: the thickness of what is flat is mostly noise.
  const float surface =
      2.f * area_m2(shape.footprint) + perimeter_m(shape.footprint) * shape.height_m();
  switch (superlative) {
    case Superlative::kLargest:
      return {surface, evidence_of("a surface of", surface, "m2")};
    case Superlative::kSmallest:
      return {-surface, evidence_of("a surface of", surface, "m2")};
    case Superlative::kTallest:
      return {shape.height_m(), evidence_of("a height of", shape.height_m(), "m")};
    case Superlative::kShortest:
      return {-shape.height_m(), evidence_of("a height of", shape.height_m(), "m")};
    case Superlative::kHighest:
      return {shape.top_m, evidence_of("its top at", shape.top_m, "m")};
    default:
      return {-shape.bottom_m, evidence_of("its bottom at", shape.bottom_m, "m")};
  }
}

}  // namespace ovimap
