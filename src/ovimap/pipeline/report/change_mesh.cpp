// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/report/change_mesh.h"

#include <map>

#include "ovimap/instance/instance_mesh.h"
#include "ovimap/io/mesh/map_mesh.h"
#include "ovimap/io/mesh/mesh_pieces.h"

namespace ovimap {

namespace {

using ChangeColor = std::array<std::uint8_t, 3>;
constexpr ChangeColor kNewColor{40, 170, 70}, kMovedColor{40, 90, 220},
    kOldPlaceColor{140, 190, 250}, kRemovedColor{215, 45, 45};
using ColorOfObject = std::map<InstanceId, ChangeColor>;

void append_in(Mesh& mesh, Mesh piece, const ChangeColor& color) {
  piece.colors.assign(piece.vertices.size(), color);
  piece.labels.assign(piece.vertices.size(), 0);
  append(piece, mesh);
}

/// Half-way to a light grey, so that changes stand out.
ChangeColor faded(const ChangeColor& color) {
  const int grey = (2 * color[0] + 5 * color[1] + color[2]) / 8;
  const auto level = static_cast<std::uint8_t>(110 + grey / 2);
  return {level, level, level};
}

Mesh mesh_in_grey(const MapDocument& map, const ColorOfObject& colors) {
  Mesh mesh = visible_mesh(map);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const auto color = colors.find(mesh.labels[i]);
    mesh.colors[i] = color == colors.end() ? faded(mesh.colors[i]) : color->second;
  }
  return mesh;
}

/// Adds the six sides of a box, counter-clockwise from outside.
void append_box(Mesh& mesh, const Eigen::AlignedBox3f& box) {
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {0, 1}) {
      const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
      const int u = (axis + 1 + side) % 3, v = (axis + 2 - side) % 3;
      for (const auto& [along_u, along_v] : {std::pair{0, 0}, {0, 1}, {1, 1}, {1, 0}}) {
        Eigen::Vector3f corner = side == 1 ? box.max() : box.min();
        corner[u] = along_u == 1 ? box.max()[u] : box.min()[u];
        corner[v] = along_v == 1 ? box.max()[v] : box.min()[v];
        mesh.vertices.push_back(corner);
        mesh.normals.push_back((side == 1 ? 1.f : -1.f) * Eigen::Vector3f::Unit(axis));
      }
      mesh.triangles.push_back({first, first + 1, first + 2});
      mesh.triangles.push_back({first, first + 2, first + 3});
    }
}

/// What an object was before an event that ended it.
Mesh past_mesh(const ObjectEvent& event, float spacing_m) {
  Mesh mesh;
  if (!event.was || event.was->surface.empty()) {
    if (!event.before.isEmpty()) append_box(mesh, event.before);
    return mesh;
  }
  const Eigen::Vector3f half = Eigen::Vector3f::Constant(spacing_m / 2);
  for (const Eigen::Vector3f& point : event.was->surface)
    append_box(mesh, {point - half, point + half});
  return mesh;
}

/// The event that ended what an earlier one of the same object began; null: it is so now.
const ObjectEvent* next_event(const std::vector<ObjectEvent>& events, std::size_t at) {
  for (std::size_t i = at + 1; i < events.size(); ++i)
    if (events[i].instance == events[at].instance) return &events[i];
  return nullptr;
}

}  // namespace

Mesh change_mesh(const MapDocument& before, const MapDocument& after, const Pose& before_from_after,
                 const std::vector<ObjectChange>& changes) {
  ColorOfObject in_before, in_after;
  for (const ObjectChange& change : changes) {
    if (change.kind == ChangeKind::kNew) in_after[change.after] = kNewColor;
    if (change.kind == ChangeKind::kRemoved) in_before[change.before] = kRemovedColor;
    if (change.kind != ChangeKind::kMoved) continue;
    in_after[change.after] = kMovedColor;
    in_before[change.before] = kOldPlaceColor;
  }
  Mesh mesh = mesh_in_grey(after, in_after);
  const Eigen::Isometry3f pose = before_from_after.cast<float>();
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    mesh.vertices[i] = pose * mesh.vertices[i];
    mesh.normals[i] = pose.linear() * mesh.normals[i];
  }
  const auto pieces = split_by_label(visible_mesh(before));
  for (const auto& [id, color] : in_before)
    if (const auto piece = pieces.find(id); piece != pieces.end())
      append_in(mesh, piece->second, color);
  return mesh;
}

Mesh change_mesh(const MapDocument& map, const std::vector<HistoryChange>& changes) {
  const std::vector<ObjectEvent>& events = map.history.events;
  const float spacing_m = surface_spacing_m(map.map.config().voxel_size_m);
  ColorOfObject now;
  Mesh past;
  for (const HistoryChange& change : changes) {
    const bool came = change.kind == ObjectEventKind::kAppeared,
               went = change.kind == ObjectEventKind::kGone;
    if (!came)
      append_in(past, past_mesh(events[change.first], spacing_m),
                went ? kRemovedColor : kOldPlaceColor);
    if (went) continue;
    const ChangeColor color = came ? kNewColor : kMovedColor;
    if (const ObjectEvent* ended = next_event(events, change.last))
      append_in(past, past_mesh(*ended, spacing_m), color);
    else
      now[change.instance] = color;
  }
  Mesh mesh = mesh_in_grey(map, now);
  append(past, mesh);
  return mesh;
}

}  // namespace ovimap
