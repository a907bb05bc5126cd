// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

#include <atomic>

#include "ovimap/base/error.h"

namespace ovimap::python {

namespace nb = nanobind;

/// Something whose threads may call Python. They cannot once the interpreter ends, so all that is
/// still open is closed before. Made and destroyed with the GIL held, which guards the list.
class OpenHandle {
 public:
  OpenHandle();
  virtual ~OpenHandle();
  OpenHandle(const OpenHandle&) = delete;
  OpenHandle& operator=(const OpenHandle&) = delete;

  static void close_all();

 protected:
  /// The Python object, which must outlive `close`: what that destroys may hold its last reference.
  virtual nb::object self() = 0;
  /// Ends the threads; called without the GIL, so that they can end what they do in Python.
  virtual void close() noexcept = 0;
};

/// Lets one call in at a time and refuses others. They cannot wait: the one in there may itself
/// wait for a callback that made the other.
class OneCall {
 public:
  class Turn {
   public:
    explicit Turn(std::atomic<bool>& busy) : busy_(busy) {}
    ~Turn() {
      busy_ = false;
      busy_.notify_all();
    }
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

   private:
    std::atomic<bool>& busy_;
  };
  /// Throws Error when a call is under way.
  [[nodiscard]] Turn begin(const char* what) {
    if (busy_.exchange(true))
      throw Error(concat("this ", what,
                         " is at work, in another thread or below this very callback; make one "
                         "call at a time"));
    return Turn(busy_);
  }
  /// Waits for the call under way, and refuses all that come. Without the GIL, which it may need.
  void close() {
    if (closed_.exchange(true)) return;
    while (busy_.exchange(true)) busy_.wait(true);
  }

 private:
  std::atomic<bool> busy_ = false, closed_ = false;
};

}  // namespace ovimap::python
