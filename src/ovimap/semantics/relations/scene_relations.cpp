// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/relations/scene_relations.h"

#include <algorithm>
#include <limits>
#include <optional>

#include <Eigen/Geometry>

#include "ovimap/base/parallel.h"

namespace ovimap {

namespace {

/// Beside and near hold both ways: the younger id is said to be so to the older.
bool is_symmetric(Relation relation) {
  return relation == Relation::kBeside || relation == Relation::kNear;
}

class PairJudge {
 public:
  PairJudge(std::span<const InstanceId> ids, std::span<const ObjectShape> shapes,
            const RelationConfig& config)
      : ids_(ids), shapes_(shapes), config_(config) {
    const float reach = std::max({config.near_m, config.beside_m, config.overhang_m});
    for (const ObjectShape& shape : shapes) {
      const Eigen::AlignedBox3f& box = boxes_.emplace_back(upright_box(shape));
      // Above may be as high as it likes.
      const Eigen::Vector3f margin(reach, reach, std::numeric_limits<float>::infinity());
      reaches_.emplace_back(box.min() - margin, box.max() + margin);
    }
  }

  /// The first relation of `a` to `b` that holds.
  std::optional<ObjectRelation> judge(std::size_t a, std::size_t b) const {
    if (!reaches_[a].intersects(boxes_[b])) return std::nullopt;
    for (const Relation relation :
         {Relation::kOn, Relation::kInside, Relation::kAbove, Relation::kBeside, Relation::kNear}) {
      if (is_symmetric(relation) && ids_[a] < ids_[b]) continue;
      if (!may_hold(relation, a, b)) continue;
      if (is_symmetric(relation) && (holds(Relation::kOn, b, a) || holds(Relation::kInside, b, a) ||
                                     holds(Relation::kAbove, b, a)))
        return std::nullopt;
      RelationRating rating = rate(relation, a, b);
      if (rating.score >= kRelationHolds)
        return ObjectRelation{ids_[a], relation, ids_[b], rating.score, std::move(rating.evidence)};
    }
    return std::nullopt;
  }

 private:
  RelationRating rate(Relation relation, std::size_t a, std::size_t b) const {
    return rate_relation(relation, shapes_[a], shapes_[b], ids_[b], {}, config_);
  }
  bool may_hold(Relation relation, std::size_t a, std::size_t b) const {
    return highest_rating(relation, boxes_[a], boxes_[b], config_) >= kRelationHolds;
  }
  bool holds(Relation relation, std::size_t a, std::size_t b) const {
    return may_hold(relation, a, b) && rate(relation, a, b).score >= kRelationHolds;
  }

  std::span<const InstanceId> ids_;
  std::span<const ObjectShape> shapes_;
  const RelationConfig& config_;
  std::vector<Eigen::AlignedBox3f> boxes_, reaches_;  // of each shape: around it, what is near
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
