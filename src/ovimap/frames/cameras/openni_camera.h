// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/frames/cameras/rgbd_camera.h"

namespace ovimap {

/// A camera of OpenNI 2 (Kinect, Xtion, Astra), by its URI; empty: the only one. Colour and depth
/// with the factory's field of view, left and right as they are; depth is brought to colour where
/// the device can. Throws as open_camera.
std::unique_ptr<RgbdCamera> open_openni_camera(const std::string& uri,
                                               const FrameSourceConfig& config);

}  // namespace ovimap
