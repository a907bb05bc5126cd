// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// In the place of openni_camera.cpp where OpenNI's headers were not there when this was built.
#include "ovimap/base/error.h"
#include "ovimap/frames/cameras/openni_camera.h"

namespace ovimap {

std::unique_ptr<RgbdCamera> open_openni_camera(const std::string&, const FrameSourceConfig&) {
  throw Error("this ovimap was built without OpenNI; install libopenni2-dev and build it again");
}

}  // namespace ovimap
