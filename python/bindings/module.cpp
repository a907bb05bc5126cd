// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <nanobind/stl/string.h>

#include "bindings.h"
#include "callback.h"
#include "open_handle.h"
#include "ovimap/base/error.h"
#include "ovimap/base/version.h"
#include "wording.h"

namespace ovimap::python {

namespace {

PyObject *g_error = nullptr, *g_frame_error = nullptr;  // the module keeps them alive

void raise(PyObject* type, const Error& error) {
  PyErr_SetString(type, in_python_words(error.what()).c_str());
}

void translate(const std::exception_ptr& thrown, void*) {
  try {
    std::rethrow_exception(thrown);
  } catch (const FrameError& error) {
    raise(g_frame_error, error);
  } catch (const Error& error) {
    raise(g_error, error);
  }
}

void bind_errors(nb::module_& module) {
  auto error = nb::exception<Error>(module, "Error", PyExc_RuntimeError);
  error.attr("__doc__") =
      "Something you can mend: a path, a file, a setting, a model. One line says what and how. A "
      "RuntimeError.";
  auto frame_error = nb::exception<FrameError>(module, "FrameError", error.ptr());
  frame_error.attr("__doc__") =
      "An Error of one frame alone: what was mapped stands, and the frames after it may be sound. "
      "Masks may raise it to leave a frame out.";
  g_error = error.ptr();
  g_frame_error = frame_error.ptr();
  nb::register_exception_translator(&translate, nullptr);  // asked before those of the classes
}

}  // namespace

nb::handle frame_error_type() {
  return g_frame_error;
}

NB_MODULE(_ovimap, module) {
  nb::set_leak_warnings(false);  // what lives until the interpreter ends is no leak of ours
  module.attr("__doc__") = "Posed RGB-D frames to a map of objects that can be searched in words.";
  module.def("version", &version, "Version of the library, \"0.2.0\".");
  module.def("commit", &commit, "The commit the library was built from, or \"unknown\".");
  bind_errors(module);
  bind_callback_errors();
  bind_settings(module);
  bind_frames(module);
  bind_images(module);
  bind_sources(module);
  bind_check(module);
  bind_calibrate(module);
  bind_cameras(module);
  bind_masks(module);
  bind_encoders(module);
  bind_mapper(module);
  bind_live_mapper(module);
  bind_map(module);
  bind_evaluation(module);
  // Threads that call Python must have ended before the interpreter does.
  nb::module_::import_("atexit").attr("register")(nb::cpp_function(&OpenHandle::close_all));
}

}  // namespace ovimap::python
