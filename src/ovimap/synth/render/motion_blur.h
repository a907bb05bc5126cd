// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <Eigen/Core>

#include "ovimap/geometry/camera.h"
#include "ovimap/geometry/pose.h"
#include "ovimap/image/image.h"

namespace ovimap {

/// The average of what a camera sees from several poses next to its own, made from its one picture
/// (linear light) and depth (metres, 0: far away): each pixel of a pose is looked up where its ray
/// ends in the picture. What came into view meanwhile takes the colour beside it. No poses: the
/// picture itself.
Image<Eigen::Vector3f> blurred(const Image<Eigen::Vector3f>& picture, const DepthImage& depth,
                               const PinholeCamera& camera, const Pose& world_from_camera,
                               std::span<const Pose> world_from_poses);

}  // namespace ovimap
