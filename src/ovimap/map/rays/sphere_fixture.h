// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>

#include "ovimap/map/fusion/integrate.h"

namespace ovimap {

/// A sphere of 30 cm radius at the origin, seen from outside: exact depth for tests of the map.
struct SphereScene {
  static constexpr float kRadius = 0.3f;
  PinholeCamera camera{160, 120, 150.f, 150.f, 79.5f, 59.5f};

  /// Camera at 1.2 m, `azimuth_rad` around the y axis, looking at the centre.
  Pose pose(double azimuth_rad) const {
    Pose world_from_camera = Pose::Identity();
    world_from_camera.linear() = Eigen::AngleAxisd(azimuth_rad, Eigen::Vector3d::UnitY()).matrix();
    world_from_camera.translation() = world_from_camera.linear() * Eigen::Vector3d(0, 0, -1.2);
    return world_from_camera;
  }

  /// The sphere looks the same from everywhere, so one depth image serves all poses.
  DepthImage depth() const {
    DepthImage result(camera.width, camera.height);
    for (int y = 0; y < result.height(); ++y) {
      for (int x = 0; x < result.width(); ++x) {
        const Eigen::Vector3f d =
            camera.unproject(static_cast<float>(x), static_cast<float>(y), 1.f);
        const Eigen::Vector3f center(0, 0, 1.2f);
        const float b = d.dot(center), a = d.squaredNorm(),
                    c = center.squaredNorm() - kRadius * kRadius;
        const float discriminant = b * b - a * c;
        if (discriminant > 0.f) result.at(x, y) = (b - std::sqrt(discriminant)) / a;
      }
    }
    return result;
  }

  /// Exact slopes of the sphere's tangent planes.
  Image<float> plane_slope() const {
    const DepthImage image = depth();
    Image<float> result(camera.width, camera.height);
    for (int y = 0; y < image.height(); ++y)
      for (int x = 0; x < image.width(); ++x)
        if (image.at(x, y) > 0.f) {
          const Eigen::Vector3f point =
              camera.unproject(static_cast<float>(x), static_cast<float>(y), image.at(x, y));
          const Eigen::Vector3f normal = (point - Eigen::Vector3f(0, 0, 1.2f)).normalized();
          result.at(x, y) = -normal.dot(point) / point.z();
        }
    return result;
  }

  /// Integrates `views` views all around; every pixel belongs to segment 1 with the given label.
  void integrate_views(VoxelMap& map, int views, Label label, Rgb8 color = {200, 100, 50}) const {
    const DepthImage image = depth();
    const Image<float> slopes = plane_slope();
    const RgbImage colors(camera.width, camera.height, color);
    const IdImage segments(camera.width, camera.height, 1);
    const std::array<Label, 1> labels{label};
    for (int i = 0; i < views; ++i) {
      const Pose world_from_camera = pose(2 * M_PI * i / views);
      integrate(map, {.depth = image,
                      .camera = camera,
                      .world_from_camera = world_from_camera,
                      .color = &colors,
                      .plane_slope = &slopes,
                      .segment_ids = &segments,
                      .segment_labels = labels});
    }
  }
};

}  // namespace ovimap
