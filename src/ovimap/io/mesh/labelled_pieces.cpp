// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/mesh/labelled_pieces.h"

#include "ovimap/io/mesh/mesh_pieces.h"

namespace ovimap {

namespace {

template <class Value>
std::uint64_t append_values(ScratchFile& file, const std::vector<Value>& values) {
  file.append(
      {reinterpret_cast<const std::uint8_t*>(values.data()), values.size() * sizeof(Value)});
  return values.size();
}

/// Moves `at` behind them.
template <class Value>
std::vector<Value> values_at(const ScratchFile& file, std::uint64_t& at, std::uint64_t count) {
  std::vector<Value> values(count);
  file.read(at, {reinterpret_cast<std::uint8_t*>(values.data()), count * sizeof(Value)});
  at += count * sizeof(Value);
  return values;
}

}  // namespace

LabelledPieces::LabelledPieces(const MeshParts& parts, const std::filesystem::path& target)
    : file_(target) {
  parts([&](const Mesh& part) {
    for (const auto& [label, piece] : split_by_label(part)) places_[label].push_back(keep(piece));
  });
}

LabelledPieces::Place LabelledPieces::keep(const Mesh& piece) {
  Place place{.begin = file_.size()};
  place.vertices = append_values(file_, piece.vertices);
  place.normals = append_values(file_, piece.normals);
  place.colors = append_values(file_, piece.colors);
  place.labels = append_values(file_, piece.labels);
  place.triangles = append_values(file_, piece.triangles);
  return place;
}

Mesh LabelledPieces::read(Place place) const {
  Mesh piece;
  std::uint64_t at = place.begin;
  piece.vertices = values_at<Eigen::Vector3f>(file_, at, place.vertices);
  piece.normals = values_at<Eigen::Vector3f>(file_, at, place.normals);
  piece.colors = values_at<std::array<std::uint8_t, 3>>(file_, at, place.colors);
  piece.labels = values_at<std::uint32_t>(file_, at, place.labels);
  piece.triangles = values_at<std::array<std::uint32_t, 3>>(file_, at, place.triangles);
  return piece;
}

Mesh LabelledPieces::piece(std::uint32_t label) const {
  Mesh mesh;
  const auto found = places_.find(label);
  if (found == places_.end()) return mesh;
  for (const Place& place : found->second) append(read(place), mesh);
  return mesh;
}

}  // namespace ovimap
