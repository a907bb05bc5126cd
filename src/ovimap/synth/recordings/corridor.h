// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "ovimap/frames/frame/frame_source.h"

namespace ovimap {

struct CorridorConfig {
  int frames = 5000;
  float step_m = 0.06f;           ///< forward motion from frame to frame
  int width = 320, height = 240;  ///< pixels
  bool hung = false;              ///< small boxes hang on the walls as well, some 2.5 a metre
  std::uint32_t seed = 1;
};

/// A camera that walks down an endless corridor with boxes along its walls: frames are computed as
/// they are read, by intersecting rays with boxes, so that a walk of hundreds of metres costs
/// nothing to keep. For measuring whether mapping slows down as the map grows. True ids: 1 floor, 2
/// ceiling, 3 and 4 walls, from 5 on the boxes.
class CorridorSource : public FrameSource {
 public:
  explicit CorridorSource(const CorridorConfig& config);

  std::string kind() const override { return "corridor"; }
  std::int64_t size() const override { return config_.frames; }
  [[nodiscard]] FrameRead read(std::int64_t position) const override;
  [[nodiscard]] std::optional<IdImage> truth_ids(std::int64_t position) const override;

  const PinholeCamera& camera() const { return camera_; }
  const std::vector<Eigen::AlignedBox3f>& boxes() const { return boxes_; }

 private:
  struct Hit {
    float depth_m = 0;
    std::uint16_t id = 0;
    int face = 0;  ///< axis of the surface's normal
  };

  void add_box(float side, float depth, const Eigen::Vector2f& along, const Eigen::Vector2f& up);
  Pose pose(std::int64_t position) const;
  std::vector<std::size_t> boxes_near(float x) const;
  Hit trace(const Eigen::Vector3f& eye, const Eigen::Vector3f& ray,
            const std::vector<std::size_t>& near) const;
  template <class Visit>
  void for_each_pixel(std::int64_t position, const Visit& visit) const;

  CorridorConfig config_;
  PinholeCamera camera_;
  std::vector<Eigen::AlignedBox3f> boxes_;  ///< those on the floor first
};

}  // namespace ovimap
