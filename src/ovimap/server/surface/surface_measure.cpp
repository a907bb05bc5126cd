// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/surface/surface_measure.h"

#include <algorithm>

#include "ovimap/io/mesh/mesh_pieces.h"

namespace ovimap {

namespace {

struct Extent {
  std::size_t points = 0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::AlignedBox3f box;

  void add(const Eigen::Vector3f& point) {
    ++points;
    sum += point.cast<double>();
    box.extend(point);
  }
  void add(const Extent& other) {
    points += other.points;
    sum += other.sum;
    box.extend(other.box);
  }
  void fill(InstanceSummary& summary) const {
    summary.points = points;
    summary.box = box;
    if (points > 0) summary.centroid = (sum / static_cast<double>(points)).cast<float>();
  }
};

std::vector<Extent> extents_by_label(const Mesh& mesh) {
  std::vector<Extent> extents;
  for (std::size_t v = 0; v < mesh.labels.size(); ++v) {
    const std::uint32_t label = mesh.labels[v];
    if (label >= extents.size()) extents.resize(label + 1);
    extents[label].add(mesh.vertices[v]);
  }
  return extents;
}

template <class Value>
void append(const std::vector<Value>& from, std::vector<Value>& to) {
  to.insert(to.end(), from.begin(), from.end());
}

void append(const Mesh& from, Mesh& to) {
  const auto first = static_cast<std::uint32_t>(to.vertices.size());
  append(from.vertices, to.vertices);
  append(from.normals, to.normals);
  append(from.colors, to.colors);
  append(from.labels, to.labels);
  for (const auto& [a, b, c] : from.triangles)
    to.triangles.push_back({first + a, first + b, first + c});
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

Mesh joined_surface(const MeshStore& store) {
  Mesh mesh;
  for (const auto& chunk : store.chunks())
    for (const SurfacePatch& patch : chunk->patches) append(*patch.mesh, mesh);
  return mesh;
}

void relabel(Mesh& mesh, const LabelTable& table) {
  for (std::uint32_t& label : mesh.labels) label = label < table.size() ? table[label] : 0;
}

Mesh labelled_surface(const MeshStore& store, const LabelTable& table,
                      const std::set<InstanceId>& hidden) {
  Mesh mesh = joined_surface(store);
  relabel(mesh, table);
  if (hidden.empty()) return mesh;
  return without_labels(mesh, [&](std::uint32_t label) { return hidden.contains(label); });
}

std::vector<InstanceSummary> find_instances(const Mesh& mesh, const LabelForest& forest,
                                            const InstanceRegistry& registry,
                                            const InstanceSummaryConfig& config) {
  std::map<Label, Extent> by_root;
  const std::vector<Extent> by_label = extents_by_label(mesh);
  for (Label label = 1; label < by_label.size(); ++label)
    if (by_label[label].points > 0) by_root[forest.root(label)].add(by_label[label]);
  std::map<InstanceId, Extent> found;
  for (const auto& [root, extent] : by_root)
    if (const InstanceId id = registry.instance_of(root); id != 0) found[id].add(extent);
  std::vector<InstanceSummary> result;
  for (const auto& [id, extent] : found) {
    InstanceSummary summary;
    summary.id = id;
    summary.views = registry.record(id).views;
    summary.super_points = registry.super_points_of(id);
    extent.fill(summary);
    if (summary.points >= static_cast<std::size_t>(config.min_instance_voxels) &&
        summary.views >= config.min_instance_views)
      result.push_back(std::move(summary));
  }
  return result;
}

void measure_on_surface(const Mesh& mesh, float spacing_m, MapRecord& record) {
  const std::vector<Extent> extents = extents_by_label(mesh);
  for (auto* list : {&record.instances, &record.hidden})
    for (InstanceSummary& instance : *list)
      (instance.id < extents.size() ? extents[instance.id] : Extent{}).fill(instance);
  record.surfaces = sample_surfaces(mesh, spacing_m);
}

}  // namespace ovimap
