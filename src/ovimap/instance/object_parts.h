// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <span>
#include <vector>

#include "ovimap/instance/consensus/edge_contraction.h"
#include "ovimap/instance/instance_summary.h"

namespace ovimap {

/// A piece of an object that masks show by itself: a drawer of a cabinet, a cushion of a sofa. Its
/// `id` is its oldest super-point, which tells it from all other parts of a map; `views` counts the
/// frames that told it from the rest of its object.
using ObjectPart = InstanceSummary;

/// Those of one object that consists of these super-points (roots, ascending): what 2D entities of
/// frames keep apart more often than they join it, where the object was put together for other
/// reasons (PairJudge). A part is told by at least `least_frames` frames that show it and more of
/// the object in different entities. Without box and points; ascending by id. None when the whole
/// object is one to the masks as well.
std::vector<ObjectPart> find_parts(std::span<const Label> super_points,
                                   const EntitySightings& sightings, int least_frames);

/// The same of all objects of a measured map. Parts smaller than an object may be
/// (`config.min_instance_voxels`) are left out, and so is what is nearly all of its object
/// (`config.max_part_share`): the rest is its fringe. Boxes reach no further than those of their
/// objects. Ascending by id.
std::vector<ObjectPart> find_parts(const SurfaceExtents& extents,
                                   std::span<const InstanceSummary> objects,
                                   const EntitySightings& sightings,
                                   const InstanceSummaryConfig& config);

/// To each object those parts that lie wholly in it, whatever corrections made of it since.
std::map<InstanceId, std::vector<const ObjectPart*>> parts_by_object(
    std::span<const ObjectPart> parts, std::span<const InstanceSummary> objects);

}  // namespace ovimap
