// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

#include <memory>
#include <stdexcept>

namespace ovimap::python {

namespace nb = nanobind;

/// What a Python callable raised, on whatever thread. It can be kept and thrown several times;
/// nb::python_error gives its exception to Python once.
class CallbackError : public std::runtime_error {
 public:
  /// With the GIL held, as `raise`.
  explicit CallbackError(const nb::python_error& error);
  /// Raises the exception in Python, with its traceback.
  void raise() const;

 private:
  std::shared_ptr<PyObject> exception_;
};

/// Lets Python raise what CallbackErrors hold where they come out.
void bind_callback_errors();

/// Calls something of Python's on any thread, which waits for the GIL. Throws CallbackError.
template <class Call>
auto call_python(const Call& call) {
  const nb::gil_scoped_acquire acquire;
  try {
    return call();
  } catch (const nb::python_error& error) {
    throw CallbackError(error);
  }
}

}  // namespace ovimap::python
