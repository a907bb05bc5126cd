// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/mesh/map_mesh.h"

#include <set>
#include <utility>

#include "ovimap/instance/instance_mesh.h"
#include "ovimap/io/mesh/mesh_pieces.h"
#include "ovimap/map/surface/incremental_mesh.h"
#include "ovimap/map/surface/mesh_extraction.h"

namespace ovimap {

namespace {

constexpr std::size_t kTrianglesOfPart = 500000;  // some 40 MB while it is drawn

/// What the map shows, and what is hidden in it.
struct Shown {
  std::vector<InstanceSummary> all;
  std::set<InstanceId> hidden;
};

Shown shown_in(const MapDocument& document) {
  Shown shown{document.instances, {}};
  for (const InstanceSummary& instance : document.hidden) {
    shown.all.push_back(instance);
    shown.hidden.insert(instance.id);
  }
  return shown;
}

Mesh without_hidden(Mesh mesh, const std::set<InstanceId>& hidden) {
  if (hidden.empty()) return mesh;
  return without_labels(mesh, [&](std::uint32_t label) { return hidden.contains(label); });
}

}  // namespace

Mesh visible_mesh(const MapDocument& document) {
  const Shown shown = shown_in(document);
  return without_hidden(extract_instance_mesh(document.map, shown.all), shown.hidden);
}

void for_each_visible_part(const MapDocument& document,
                           const std::function<void(const Mesh&)>& visit) {
  const Shown shown = shown_in(document);
  const std::vector<InstanceId> instance_of = instances_by_label(document.map, shown.all);
  Mesh part;
  const auto finish = [&] {
    add_normals(part);
    visit(without_hidden(std::exchange(part, {}), shown.hidden));
  };
  for_each_patch(document.map, [&](Mesh& patch) {
    for (std::uint32_t& label : patch.labels) label = instance_of[label];
    append(patch, part);
    if (part.triangles.size() >= kTrianglesOfPart) finish();
  });
  if (!part.triangles.empty()) finish();
}

}  // namespace ovimap
