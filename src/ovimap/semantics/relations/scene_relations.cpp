// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/relations/scene_relations.h"

#include <algorithm>
#include <optional>

#include <Eigen/Geometry>

#include "ovimap/base/parallel.h"

namespace ovimap {

namespace {

constexpr float kHolds = 0.5f;

/// The upright box of a shape, which spares distant pairs the search for their nearest points.
Eigen::AlignedBox3f box_of(const ObjectShape& shape) {
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector2f& corner : shape.footprint) {
    box.extend(Eigen::Vector3f(corner.x(), corner.y(), shape.bottom_m));
    box.extend(Eigen::Vector3f(corner.x(), corner.y(), shape.top_m));
  }
  return box;
}

float horizontal_gap(const Eigen::AlignedBox3f& a, const Eigen::AlignedBox3f& b) {
  const Eigen::Vector2f outside =
      (a.min() - b.max()).cwiseMax(b.min() - a.max()).head<2>().cwiseMax(0.f);
  return outside.norm();
}

/// Beside and near hold both ways: the younger id is said to be so to the older.
bool is_symmetric(Relation relation) {
  return relation == Relation::kBeside || relation == Relation::kNear;
}

class PairJudge {
 public:
  PairJudge(std::span<const InstanceId> ids, std::span<const ObjectShape> shapes,
            const RelationConfig& config)
      : ids_(ids), shapes_(shapes), config_(config) {
    for (const ObjectShape& shape : shapes) boxes_.push_back(box_of(shape));
  }

  /// The first relation of `a` to `b` that holds.
  std::optional<ObjectRelation> judge(std::size_t a, std::size_t b) const {
    const float reach = std::max({config_.near_m, config_.beside_m, config_.overhang_m});
    if (horizontal_gap(boxes_[a], boxes_[b]) > reach) return std::nullopt;
    for (const Relation relation :
         {Relation::kOn, Relation::kInside, Relation::kAbove, Relation::kBeside, Relation::kNear}) {
      if (is_symmetric(relation) && ids_[a] < ids_[b]) continue;
      if (is_symmetric(relation) && (holds(Relation::kOn, b, a) || holds(Relation::kInside, b, a) ||
                                     holds(Relation::kAbove, b, a)))
        return std::nullopt;
      RelationRating rating = rate(relation, a, b);
      if (rating.score >= kHolds)
        return ObjectRelation{ids_[a], relation, ids_[b], rating.score, std::move(rating.evidence)};
    }
    return std::nullopt;
  }

 private:
  RelationRating rate(Relation relation, std::size_t a, std::size_t b) const {
    return rate_relation(relation, shapes_[a], shapes_[b], ids_[b], {}, config_);
  }
  bool holds(Relation relation, std::size_t a, std::size_t b) const {
    return rate(relation, a, b).score >= kHolds;
  }

  std::span<const InstanceId> ids_;
  std::span<const ObjectShape> shapes_;
  const RelationConfig& config_;
  std::vector<Eigen::AlignedBox3f> boxes_;
};

}  // namespace

std::vector<ObjectRelation> find_relations(std::span<const InstanceId> ids,
                                           std::span<const ObjectShape> shapes,
                                           const RelationConfig& config) {
  OVIMAP_ASSERT(ids.size() == shapes.size());
  const PairJudge judge(ids, shapes, config);
  std::vector<std::vector<ObjectRelation>> of_object(ids.size());
  parallel_for(ids.size(), 1, [&](std::size_t a) {
    for (std::size_t b = 0; b < ids.size(); ++b)
      if (a != b)
        if (auto relation = judge.judge(a, b)) of_object[a].push_back(std::move(*relation));
  });
  std::vector<ObjectRelation> relations;
  for (auto& list : of_object) std::move(list.begin(), list.end(), std::back_inserter(relations));
  return relations;
}

}  // namespace ovimap
