// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

#include <atomic>

namespace ovimap::python {

/// Lets other threads of Python run while this one works, as nb::gil_scoped_release does. Python
/// ends daemon threads where they next ask for the GIL, which below C++ means std::terminate, so
/// the interpreter's end waits for those that are out, and lets no more out.
class WithoutGil {
 public:
  WithoutGil() {
    if (ending_) return;
    ++out_;
    thread_ = PyEval_SaveThread();
  }
  ~WithoutGil() {
    if (thread_ == nullptr) return;
    PyEval_RestoreThread(thread_);
    if (--out_ == 0) out_.notify_all();
  }
  WithoutGil(const WithoutGil&) = delete;
  WithoutGil& operator=(const WithoutGil&) = delete;

  /// From now on nobody is let out. With the GIL held.
  static void end() { ending_ = true; }
  /// Waits until all that are out are back. Without the GIL, which they need for that.
  static void await_all() {
    for (int out = out_; out > 0; out = out_) out_.wait(out);
  }

 private:
  static inline std::atomic<bool> ending_ = false;
  static inline std::atomic<int> out_ = 0;
  PyThreadState* thread_ = nullptr;
};

}  // namespace ovimap::python
