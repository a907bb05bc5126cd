// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/cameras/rgbd_camera.h"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include "bindings.h"
#include "ovimap/base/error.h"
#include "without_gil.h"

namespace ovimap::python {

namespace {

/// A camera, and how it was lost.
class PluggedCamera {
 public:
  explicit PluggedCamera(const std::string& source) {
    if (!names_camera(source)) throw Error(concat("'", source, "' names no camera; give openni:"));
    const WithoutGil release;
    camera_ = open_camera(source);
  }

  const RgbdCamera& camera() const { return *camera_; }
  const std::string& fault() const { return fault_; }
  std::optional<Frame> next(double patience_s) {
    const WithoutGil release;
    CameraRead read = camera_->next(std::chrono::milliseconds(static_cast<int>(1000 * patience_s)));
    fault_ = std::move(read.fault);
    return std::move(read.frame);
  }

 private:
  std::unique_ptr<RgbdCamera> camera_;
  std::string fault_;
};

}  // namespace

void bind_cameras(nb::module_& module) {
  nb::class_<PluggedCamera>(
      module, "RgbdCamera",
      "A depth camera that is plugged in; source: \"openni:\" or \"openni:URI\". "
      "For one thread. Raises Error where there is none, or several.")
      .def(nb::init<const std::string&>(), nb::arg("source"))
      .def_prop_ro("name", [](const PluggedCamera& camera) { return camera.camera().name(); })
      .def_prop_ro(
          "registered", [](const PluggedCamera& camera) { return camera.camera().registered(); },
          "whether it brings its depth to the colour image")
      .def_prop_ro(
          "depth_units_per_m",
          [](const PluggedCamera& camera) { return camera.camera().depth_units_per_m(); },
          "what it measures depth in: 1000 or 10000")
      .def_prop_ro("fault", &PluggedCamera::fault,
                   "how it was lost, as \"was unplugged\"; \"\": it was not")
      .def("next", &PluggedCamera::next, nb::arg("patience_s"),
           "The next frame, without a pose; None when none came so soon, or the camera is lost.");
}

}  // namespace ovimap::python
