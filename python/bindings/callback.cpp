// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "callback.h"

#include <exception>
#include <string>

namespace ovimap::python {

namespace {

void release(PyObject* object) {
  if (!nb::is_alive()) return;
  const nb::gil_scoped_acquire acquire;
  Py_DECREF(object);
}

/// "ValueError: it has 7 numbers".
std::string line_of(const nb::python_error& error) {
  const std::string type = nb::cast<std::string>(error.type().attr("__name__"));
  try {
    const std::string text = nb::cast<std::string>(nb::str(error.value()));
    return text.empty() ? type : type + ": " + text.substr(0, text.find('\n'));
  } catch (const nb::python_error&) {  // what its own __str__ raises
    return type;
  }
}

}  // namespace

CallbackError::CallbackError(const nb::python_error& error)
    : std::runtime_error(line_of(error)), exception_(error.value().inc_ref().ptr(), &release) {
  if (error.traceback().is_valid())
    PyException_SetTraceback(exception_.get(), error.traceback().ptr());
}

void CallbackError::raise() const {
  PyErr_SetObject(reinterpret_cast<PyObject*>(Py_TYPE(exception_.get())), exception_.get());
}

void bind_callback_errors() {
  nb::register_exception_translator(
      [](const std::exception_ptr& thrown, void*) {
        try {
          std::rethrow_exception(thrown);
        } catch (const CallbackError& error) {
          error.raise();
        }
      },
      nullptr);
}

}  // namespace ovimap::python
