// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include <Eigen/Core>

namespace ovimap {

/// A triangle mesh in the world frame, metres. Per-vertex attributes are empty or as long as
/// vertices.
struct Mesh {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<Eigen::Vector3f> normals;             ///< unit length, outward
  std::vector<std::array<std::uint8_t, 3>> colors;  ///< RGB
  std::vector<std::uint32_t> labels;                ///< instance id (or label) per vertex; 0 = none
  std::vector<std::array<std::uint32_t, 3>>
      triangles;  ///< vertex indices, counter-clockwise from outside
};

/// A mesh that is never in memory as a whole: calls the function that it gets with one part after
/// the other, the same whenever it is called.
using MeshParts = std::function<void(const std::function<void(const Mesh&)>&)>;

}  // namespace ovimap
