// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include <Eigen/Core>

#include "ovimap/synth/rooms/room.h"

namespace ovimap {

inline constexpr float kFarthestSeen_m = 16;  ///< no depth camera sees farther

/// Where a ray meets a surface.
struct RayHit {
  double distance = 0;  ///< in lengths of the ray's direction, from the triangle's plane in double
  std::uint32_t object = 0;    ///< index into the objects
  std::uint32_t triangle = 0;  ///< index into that object's triangles
  Eigen::Vector3f weights;     ///< of the triangle's vertices at the hit, they add up to one
  Eigen::Vector3f normal;      ///< of the triangle, unit length, against the ray
};

/// Ray casting among the objects of a room (Embree). Safe to use from many threads.
class RayScene {
 public:
  /// `objects` must outlive the scene.
  explicit RayScene(std::span<const RoomObject> objects);
  ~RayScene();
  RayScene(RayScene&&) noexcept;
  RayScene& operator=(RayScene&&) noexcept;

  /// The nearest surface in front of `origin` along `direction` (any length).
  [[nodiscard]] std::optional<RayHit> trace(const Eigen::Vector3d& origin,
                                            const Eigen::Vector3d& direction) const;

  /// Whether anything lies on the ray between `origin` and `origin + reach * direction`.
  bool occluded(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float reach) const;

  std::span<const RoomObject> objects() const { return objects_; }

 private:
  struct Handle;
  std::span<const RoomObject> objects_;
  std::unique_ptr<Handle> handle_;
};

}  // namespace ovimap
