// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <vector>

#include "ovimap/instance/instance_summary.h"
#include "ovimap/io/map_tables/map_document.h"
#include "ovimap/server/surface/served_surface.h"

namespace ovimap {

/// The object that each label of a map belongs to, by label; 0: to none. Labels that were merged
/// away are translated as well, since the surface may still show them.
using LabelTable = std::vector<InstanceId>;
LabelTable label_table(const MapRecord& corrected, const LabelForest& forest);

/// The surface in all detail of the chunks that meet `box`, its labels as the map has them.
Mesh joined_surface(const ServedSurface& surface, const Eigen::AlignedBox3f& box = all_space());

/// The same with ids of objects as labels, and without what belongs to `hidden` ones.
Mesh labelled_surface(const ServedSurface& surface, const LabelTable& table,
                      const std::set<InstanceId>& hidden,
                      const Eigen::AlignedBox3f& box = all_space());

/// The same for a surface that may be more than memory holds; calling it calls the surface.
MeshParts labelled_parts(const ServedSurface& surface, const LabelTable& table,
                         const std::set<InstanceId>& hidden);

/// Replaces every label by its object.
void relabel(Mesh& mesh, const LabelTable& table);

/// Which objects a map has while it is being made, as summarize_objects finds them in voxels, here
/// from the surface: `points` counts its vertices. `mesh`: joined_surface; `edits`: its log.
std::vector<InstanceSummary> find_instances(const Mesh& mesh, const LabelForest& forest,
                                            const InstanceRegistry& registry,
                                            const InstanceSummaryConfig& config,
                                            const MapEdits& edits);

/// Boxes, centroids, counts and surfaces of all objects of the record. `mesh`: with ids as labels.
void measure_on_surface(const Mesh& mesh, float spacing_m, MapRecord& record);

}  // namespace ovimap
