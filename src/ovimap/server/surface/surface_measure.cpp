// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/surface/surface_measure.h"

#include <algorithm>
#include <utility>

#include "ovimap/instance/object_boxes.h"
#include "ovimap/io/mesh/mesh_pieces.h"
#include "ovimap/pipeline/sequence/map_description.h"

namespace ovimap {

namespace {

std::vector<SurfaceExtent> extents_by_label(const Mesh& mesh) {
  std::vector<SurfaceExtent> extents;
  for (std::size_t v = 0; v < mesh.labels.size(); ++v) {
    const std::uint32_t label = mesh.labels[v];
    if (label >= extents.size()) extents.resize(label + 1);
    extents[label].add(mesh.vertices[v]);
  }
  return extents;
}

Mesh labelled(Mesh mesh, const LabelTable& table, const std::set<InstanceId>& hidden) {
  relabel(mesh, table);
  if (hidden.empty()) return mesh;
  return without_labels(mesh, [&](std::uint32_t label) { return hidden.contains(label); });
}

}  // namespace

LabelTable label_table(const MapRecord& corrected, const LabelForest& forest) {
  LabelTable of_root(forest.roots().size(), 0);
  for (const auto* list : {&corrected.instances, &corrected.hidden})
    for (const InstanceSummary& instance : *list)
      for (const Label root : instance.super_points)
        if (root < of_root.size()) of_root[root] = instance.id;
  LabelTable table(of_root.size(), 0);
  for (Label label = 0; label < table.size(); ++label) table[label] = of_root[forest.root(label)];
  return table;
}

Mesh joined_surface(const ServedSurface& surface, const Eigen::AlignedBox3f& box) {
  Mesh mesh;
  surface.for_each_patch(box, [&](const SurfacePatch& patch) { append(*patch.mesh, mesh); });
  return mesh;
}

void relabel(Mesh& mesh, const LabelTable& table) {
  for (std::uint32_t& label : mesh.labels) label = label < table.size() ? table[label] : 0;
}

Mesh labelled_surface(const ServedSurface& surface, const LabelTable& table,
                      const std::set<InstanceId>& hidden, const Eigen::AlignedBox3f& box) {
  return labelled(joined_surface(surface, box), table, hidden);
}

MeshParts labelled_parts(const ServedSurface& surface, const LabelTable& table,
                         const std::set<InstanceId>& hidden) {
  constexpr std::size_t kTriangles = 500000;  // patches of live maps are small
  return [&](const auto& visit) {
    Mesh part;
    const auto finish = [&] { visit(labelled(std::exchange(part, {}), table, hidden)); };
    surface.for_each_patch(all_space(), [&](const SurfacePatch& patch) {
      append(*patch.mesh, part);
      if (part.triangles.size() >= kTriangles) finish();
    });
    finish();
  };
}

std::vector<InstanceSummary> find_instances(const Mesh& mesh, const LabelForest& forest,
                                            const InstanceRegistry& registry,
                                            const InstanceSummaryConfig& config,
                                            const MapEdits& edits) {
  SurfaceExtents by_root;
  const std::vector<SurfaceExtent> by_label = extents_by_label(mesh);
  for (Label label = 1; label < by_label.size(); ++label)
    if (by_label[label].points > 0) by_root[forest.root(label)] += by_label[label];
  return summarize_objects(by_root, forest, registry, config, edits);
}

void measure_on_surface(const Mesh& mesh, float spacing_m, MapRecord& record) {
  const std::vector<SurfaceExtent> extents = extents_by_label(mesh);
  record.surfaces = sample_surfaces(mesh, spacing_m);
  for (auto* list : {&record.instances, &record.hidden}) {
    for (InstanceSummary& instance : *list)
      describe(instance.id < extents.size() ? extents[instance.id] : SurfaceExtent{}, instance);
    fit_boxes(record.surfaces, spacing_m, *list);
  }
}

}  // namespace ovimap
