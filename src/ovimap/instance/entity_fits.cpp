// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/instance/entity_fits.h"

namespace ovimap {

namespace {

constexpr float kFramesOfDoubt = 2;

}  // namespace

EntityFits::EntityFits(const SurfaceExtents& extents, const EntitySightings& sightings)
    : extents_(extents), sightings_(sightings) {
  for (const auto& [root, seen] : sightings_) {
    const std::size_t points = points_of(root);
    if (points == 0) continue;
    for (const EntitySighting& sighting : seen) points_[sighting] += points;
  }
}

std::size_t EntityFits::points_of(Label root) const {
  const auto extent = extents_.find(root);
  return extent == extents_.end() ? 0 : extent->second.points;
}

std::vector<EntityFit> EntityFits::of(std::span<const Label> super_points) const {
  std::map<EntitySighting, std::size_t> own;
  std::map<std::uint32_t, std::size_t> in_sight;
  for (const Label root : super_points) {
    const auto seen = sightings_.find(root);
    const std::size_t points = points_of(root);
    if (seen == sightings_.end() || points == 0) continue;
    for (const EntitySighting& sighting : seen->second) {
      own[sighting] += points;
      in_sight[sighting.frame] += points;
    }
  }
  std::map<std::uint32_t, EntityFit> best;
  for (const auto& [sighting, shared] : own) {
    const std::size_t either = in_sight.at(sighting.frame) + points_.at(sighting) - shared;
    const EntityFit fit{static_cast<float>(shared) / static_cast<float>(either), sighting};
    EntityFit& known = best[sighting.frame];
    if (fit.rated_overlap() > known.rated_overlap()) known = fit;
  }
  std::vector<EntityFit> fits;
  for (const auto& [frame, fit] : best) fits.push_back(fit);
  return fits;
}

float EntityFits::confidence(std::span<const Label> super_points) const {
  const std::vector<EntityFit> fits = of(super_points);
  float sum = 0;
  for (const EntityFit& fit : fits) sum += fit.rated_overlap();
  return sum / (static_cast<float>(fits.size()) + kFramesOfDoubt);
}

}  // namespace ovimap
