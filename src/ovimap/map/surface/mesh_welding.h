// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include <tsl/robin_map.h>

#include "ovimap/geometry/mesh.h"

namespace ovimap {

/// Joins meshes into one whose vertices at the same place, to the bit, are one: that of the mesh
/// which came first. Without normals.
class MeshWelder {
 public:
  void add(const Mesh& part);
  std::size_t triangles() const { return mesh_.triangles.size(); }
  /// What was added since the last call.
  Mesh take();

 private:
  struct PlaceHash {
    std::size_t operator()(const Eigen::Vector3f& place) const {
      std::uint32_t bits[3];
      std::memcpy(bits, place.data(), sizeof bits);
      return (bits[0] * 73856093ull) ^ (bits[1] * 19349663ull) ^ (bits[2] * 83492791ull);
    }
  };

  Mesh mesh_;
  tsl::robin_map<Eigen::Vector3f, std::uint32_t, PlaceHash> vertex_at_;
  std::vector<std::uint32_t> vertex_of_;  ///< of the part that is being added
};

Mesh welded(std::span<const Mesh> parts);

}  // namespace ovimap
