// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <type_traits>

namespace ovimap {

namespace detail {
using RangeFunction = void (*)(void* context, std::size_t begin, std::size_t end);
void parallel_ranges(std::size_t count, std::size_t grain, void* context, RangeFunction function);
}  // namespace detail

/// Calls `body(begin, end)` over [0, count) cut into ranges of at most `grain` items, in parallel.
/// The cuts depend on `count` and `grain` alone, never on the number of threads, so a body that
/// writes per-range results and a reduction in range order give the same bits on every machine.
template <class Body>
void parallel_for_ranges(std::size_t count, std::size_t grain, Body&& body) {
  using Plain = std::remove_reference_t<Body>;
  detail::parallel_ranges(count, grain, const_cast<std::remove_const_t<Plain>*>(&body),
                          [](void* context, std::size_t begin, std::size_t end) {
                            (*static_cast<Plain*>(context))(begin, end);
                          });
}

/// Calls `body(i)` for every i in [0, count), in parallel, `grain` consecutive items per task.
template <class Body>
void parallel_for(std::size_t count, std::size_t grain, Body&& body) {
  parallel_for_ranges(count, grain, [&body](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) body(i);
  });
}

/// Runs `body`, and every parallel_for and every task of oneTBB in it, on the calling thread alone.
void on_this_thread(const std::function<void()>& body);

/// How many threads may run the bodies of a parallel_for: as many as there are cores, or fewer
/// while a ThreadLimit lives.
std::size_t allowed_threads();

/// While alive, no more than `threads` threads run the bodies of any parallel_for in this process
/// (0: all cores), the threads that call one included.
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

 private:
  struct Control;
  std::unique_ptr<Control> control_;
};

}  // namespace ovimap
