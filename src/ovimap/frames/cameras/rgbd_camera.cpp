// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/cameras/rgbd_camera.h"

#include <string_view>

#include "ovimap/base/error.h"
#include "ovimap/frames/cameras/openni_camera.h"

namespace ovimap {

namespace {

constexpr std::string_view kOpenNi = "openni:";

}  // namespace

bool names_camera(const std::string& source) {
  return source.starts_with(kOpenNi);
}

std::unique_ptr<RgbdCamera> open_camera(const std::string& source,
                                        const FrameSourceConfig& config) {
  OVIMAP_ASSERT(names_camera(source));
  return open_openni_camera(source.substr(kOpenNi.size()), config);
}

}  // namespace ovimap
