// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sstream>
#include <stdexcept>
#include <string>

namespace ovimap {

/// Something the user can mend: a path, a file, a setting, a model, a map version. The message is
/// one line that names the thing, its value, what is accepted and the remedy. Thrown only at
/// boundaries (construct, load, save, connect); normal absence is an optional, a pointer or a
/// status instead.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// An Error of one frame alone: what was mapped stands, and the frames after it may be sound.
class FrameError : public Error {
 public:
  using Error::Error;
};

/// Joins its arguments as a stream would print them: concat("frame ", 7, ": no depth").
template <class... Args>
std::string concat(const Args&... args) {
  std::ostringstream out;
  (out << ... << args);
  return out.str();
}

/// A broken promise inside ovimap itself (never the user's fault).
class DefectError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

namespace detail {
[[noreturn]] inline void assertion_failed(const char* condition, const char* file, int line) {
  throw DefectError(concat(file, ":", line, ": assertion failed: ", condition));
}
}  // namespace detail

}  // namespace ovimap

/// Checks a promise inside our own code; active in debug and sanitizer builds.
#ifdef OVIMAP_CHECKS
#define OVIMAP_ASSERT(condition) \
  ((condition) ? void(0) : ::ovimap::detail::assertion_failed(#condition, __FILE__, __LINE__))
#else
#define OVIMAP_ASSERT(condition) void(0)
#endif
