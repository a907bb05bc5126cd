// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>

#include <Eigen/Core>

#include "ovimap/geometry/camera.h"
#include "ovimap/geometry/mesh.h"
#include "ovimap/geometry/pose.h"
#include "ovimap/image/image.h"

namespace ovimap {

/// From where a mesh is drawn. Points are brought into the camera frame (x right, y down, z
/// forward); an orthographic view then drops z, and its fx, fy are pixels per metre.
struct RasterView {
  PinholeCamera camera;
  Pose world_from_camera = Pose::Identity();
  bool orthographic = false;
  float near_m = 0.05f;  ///< what lies nearer along z is cut away
  bool cull_back_faces = false;
};

/// The foremost triangle at every pixel.
struct RasterResult {
  static constexpr std::uint32_t kNoTriangle = std::numeric_limits<std::uint32_t>::max();

  Image<std::uint32_t> triangle;  ///< index into Mesh::triangles, or kNoTriangle
  Image<float> depth_m;           ///< z in the camera frame; 0 where there is no triangle
};

/// Draws all triangles with a depth buffer, exact at pixel centres; of equally near triangles the
/// first wins, so the result does not depend on the number of threads.
RasterResult rasterize(const Mesh& mesh, const RasterView& view);

/// The same of a mesh that comes in parts: draws one of them where it lies before all others.
class PartRasterizer {
 public:
  explicit PartRasterizer(const RasterView& view);
  /// The pixels at which the part is foremost so far.
  RasterResult draw(const Mesh& part);

 private:
  RasterView view_;
  Image<float> nearness_;  ///< of what was drawn
};

/// The point that pixel (u, v) shows at a depth, in the camera frame.
Eigen::Vector3f point_in_camera(const RasterView& view, int u, int v, float depth_m);

}  // namespace ovimap
