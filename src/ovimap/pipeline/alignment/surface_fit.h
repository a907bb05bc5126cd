// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "ovimap/eval/geometry/nearest.h"
#include "ovimap/geometry/mesh.h"
#include "ovimap/geometry/pose.h"

namespace ovimap {

/// Least cosine between the normals of one surface in two maps.
inline constexpr float kSameSurfaceCosine = 0.6f;

/// Points of a map's surface with unit normals that look out of it. World frame, metres.
struct SurfacePoints {
  std::vector<Eigen::Vector3f> points, normals;
};

/// One vertex of a mesh from each cube of the edge `spacing_m` that holds some.
SurfacePoints thinned_surface(const Mesh& mesh, float spacing_m);

/// Fits one surface to another: point-to-plane ICP with a shrinking reach (Chen and Medioni 1992).
/// Both surfaces must stay.
class SurfaceFit {
 public:
  SurfaceFit(const SurfacePoints& a, const SurfacePoints& b) : a_(a), b_(b), nearest_(a.points) {}

  /// Moves b from a pose, `rounds` steps with each reach: pairs of points farther apart do not
  /// count. What no pair tells stays as it is.
  Pose refine(Pose a_from_b, std::span<const float> reaches_m, int rounds) const;

 private:
  Pose step(const Pose& a_from_b, float reach_m) const;

  const SurfacePoints& a_;
  const SurfacePoints& b_;
  NearestPoints nearest_;
};

}  // namespace ovimap
