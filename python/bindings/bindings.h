// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

namespace ovimap::python {

namespace nb = nanobind;

// Each adds the classes and functions of one topic to the module.
void bind_settings(nb::module_& module);
void bind_frames(nb::module_& module);
void bind_images(nb::module_& module);
void bind_sources(nb::module_& module);
void bind_check(nb::module_& module);
void bind_calibrate(nb::module_& module);
void bind_cameras(nb::module_& module);
void bind_masks(nb::module_& module);
void bind_encoders(nb::module_& module);
void bind_mapper(nb::module_& module);
void bind_live_mapper(nb::module_& module);
void bind_map(nb::module_& module);
void bind_evaluation(nb::module_& module);

/// The type of ovimap.FrameError, which masks may raise to leave out one frame.
nb::handle frame_error_type();

}  // namespace ovimap::python
