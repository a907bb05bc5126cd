// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/instance/object_parts.h"

#include <algorithm>
#include <set>

namespace ovimap {

namespace {

// Masks tell a part as often as they tell it not: there is no reason to lean to either side.
constexpr double kApartWeight = 1.0;

std::map<Label, std::vector<Label>> clusters_of(std::span<const Label> roots,
                                                const EntitySightings& sightings) {
  std::map<Label, std::vector<Label>> clusters;
  for (const auto& [root, oldest] : contract_edges(roots, sightings, kApartWeight))
    clusters[oldest].push_back(root);
  return clusters;
}

std::set<EntitySighting> shown(std::span<const Label> roots, const EntitySightings& sightings) {
  std::set<EntitySighting> all;
  for (const Label root : roots) all.insert(sightings.at(root).begin(), sightings.at(root).end());
  return all;
}

/// Frames that show the part in entities which show nothing else of its object, beside others that
/// do.
int frames_that_tell(const std::set<EntitySighting>& part, const std::set<EntitySighting>& rest) {
  std::map<std::uint32_t, bool> alone;  // by frame
  for (const EntitySighting& sighting : part) {
    bool& by_itself = alone.try_emplace(sighting.frame, true).first->second;
    by_itself = by_itself && !rest.contains(sighting);
  }
  std::set<std::uint32_t> beside;
  for (const EntitySighting& sighting : rest) beside.insert(sighting.frame);
  return static_cast<int>(std::count_if(alone.begin(), alone.end(), [&](const auto& frame) {
    return frame.second && beside.contains(frame.first);
  }));
}

std::vector<Label> without(std::span<const Label> all, std::span<const Label> taken) {
  std::vector<Label> rest;
  std::set_difference(all.begin(), all.end(), taken.begin(), taken.end(), std::back_inserter(rest));
  return rest;
}

}  // namespace

std::vector<ObjectPart> find_parts(std::span<const Label> super_points,
                                   const EntitySightings& sightings, int least_frames) {
  std::vector<Label> seen;
  for (const Label root : super_points)
    if (sightings.contains(root)) seen.push_back(root);
  std::vector<ObjectPart> parts;
  const auto clusters = clusters_of(seen, sightings);
  if (clusters.size() < 2) return parts;
  for (const auto& [oldest, members] : clusters) {
    const int frames =
        frames_that_tell(shown(members, sightings), shown(without(seen, members), sightings));
    if (frames < least_frames) continue;
    ObjectPart& part = parts.emplace_back();
    part.id = oldest;
    part.views = frames;
    part.super_points = members;
  }
  return parts;
}

std::vector<ObjectPart> find_parts(const SurfaceExtents& extents,
                                   std::span<const InstanceSummary> objects,
                                   const EntitySightings& sightings,
                                   const InstanceSummaryConfig& config) {
  std::vector<ObjectPart> parts;
  std::map<Label, std::size_t> most_points;    // of each part
  std::map<Label, Eigen::AlignedBox3f> whole;  // of the object that it is of
  for (const InstanceSummary& object : objects)
    for (ObjectPart& part : find_parts(object.super_points, sightings, config.min_part_views)) {
      most_points[part.id] =
          static_cast<std::size_t>(config.max_part_share * static_cast<float>(object.points));
      whole[part.id] = object.box;
      parts.push_back(std::move(part));
    }
  measure_instances(extents, parts);
  std::erase_if(parts, [&](const ObjectPart& part) {
    return part.points < static_cast<std::size_t>(config.min_instance_voxels) ||
           part.points > most_points.at(part.id);
  });
  for (ObjectPart& part : parts)
    if (const auto box = part.box.intersection(whole.at(part.id)); !box.isEmpty())
      give_box(box, part);
  std::sort(parts.begin(), parts.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  return parts;
}

std::map<InstanceId, std::vector<const ObjectPart*>> parts_by_object(
    std::span<const ObjectPart> parts, std::span<const InstanceSummary> objects) {
  std::map<Label, InstanceId> owner;
  for (const InstanceSummary& object : objects)
    for (const Label label : object.super_points) owner[label] = object.id;
  std::map<InstanceId, std::vector<const ObjectPart*>> result;
  for (const ObjectPart& part : parts) {
    const auto first = owner.find(part.super_points.front());
    if (first == owner.end()) continue;
    const bool whole =
        std::all_of(part.super_points.begin(), part.super_points.end(), [&](const Label label) {
          const auto found = owner.find(label);
          return found != owner.end() && found->second == first->second;
        });
    if (whole) result[first->second].push_back(&part);
  }
  return result;
}

}  // namespace ovimap
