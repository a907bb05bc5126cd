// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/mesh/map_mesh.h"

#include <set>
#include <utility>

#include "ovimap/base/error.h"
#include "ovimap/instance/instance_mesh.h"
#include "ovimap/io/mesh/mesh_pieces.h"
#include "ovimap/map/surface/mesh_extraction.h"

namespace ovimap {

namespace {

constexpr std::size_t kTrianglesOfPart = 2'000'000;  // some 100 MB; a small room at 1 cm

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

void for_each_visible_part(const MapDocument& document, const std::function<void(Mesh&)>& visit) {
  const Shown shown = shown_in(document);
  const std::vector<InstanceId> instance_of = instances_by_label(document.map, shown.all);
  for_each_mesh_part(document.map, kTrianglesOfPart, [&](Mesh& part) {
    for (std::uint32_t& label : part.labels) label = instance_of[label];
    part = without_hidden(std::move(part), shown.hidden);
    visit(part);
  });
}

MeshParts visible_parts(const MapDocument& document, const std::filesystem::path& map,
                        std::function<void(Mesh&)> change) {
  return [&document, map, change = std::move(change)](const auto& visit) {
    bool any = false;
    for_each_visible_part(document, [&](Mesh& part) {
      any = any || !part.vertices.empty();
      change(part);
      visit(part);
    });
    if (!any)
      throw Error(concat("map '", map.string(),
                         "' holds objects without a surface, as `ovimap embed` makes them; draw "
                         "the mesh they were made from"));
  };
}

}  // namespace ovimap
