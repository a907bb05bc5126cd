// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <vector>

#include "ovimap/instance/consensus/edge_contraction.h"
#include "ovimap/instance/surface_extents.h"

namespace ovimap {

/// How well the best 2D entity of a frame fits an object: intersection over union, in points of the
/// surface, with what of the object the frame shows in entities.
struct EntityFit {
  float overlap = 0;
  EntitySighting entity;
  float rated_overlap() const {
    return overlap * static_cast<float>(entity.rating) / static_cast<float>(kHighestRating);
  }
};

/// What the 2D entities of all frames say of any object.
class EntityFits {
 public:
  /// `extents`, `sightings`: by root. Keeps both.
  EntityFits(const SurfaceExtents& extents, const EntitySightings& sightings);

  /// Of each frame that shows some of these super-points (roots) in an entity, by the entity that
  /// fits best, as much as it is rated.
  std::vector<EntityFit> of(std::span<const Label> super_points) const;

  /// How sure they are that these super-points are one whole thing, from 0 to 1: the mean of the
  /// rated overlaps over those frames and two more that show nothing, so that a frame alone says
  /// less than many.
  float confidence(std::span<const Label> super_points) const;

 private:
  std::size_t points_of(Label root) const;

  const SurfaceExtents& extents_;
  const EntitySightings& sightings_;
  std::map<EntitySighting, std::size_t> points_;  ///< of all that an entity shows
};

}  // namespace ovimap
