// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/base/parallel.h"

#include <algorithm>

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#ifdef __SANITIZE_THREAD__
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>
#endif

namespace ovimap {

namespace {

/// Calls `run(range)` for every range in [0, ranges), in parallel.
#ifdef __SANITIZE_THREAD__
// ThreadSanitizer cannot see into the installed oneTBB, which is built without it, and would report
// every hand-over of work as a race. Plain threads show it exactly what the bodies do.
template <class Run>
void for_each_range(std::size_t ranges, const Run& run) {
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  std::exception_ptr failure;
  const auto work = [&] {
    for (std::size_t range; (range = next++) < ranges;) {
      try {
        run(range);
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!failure) failure = std::current_exception();
      }
    }
  };
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) threads.emplace_back(work);
  for (std::thread& thread : threads) thread.join();
  if (failure) std::rethrow_exception(failure);
}
#else
template <class Run>
void for_each_range(std::size_t ranges, const Run& run) {
  tbb::parallel_for(std::size_t{0}, ranges, run);
}
#endif

}  // namespace

void detail::parallel_ranges(std::size_t count, std::size_t grain, void* context,
                             RangeFunction function) {
  if (count == 0) return;
  grain = std::max<std::size_t>(grain, 1);
  const std::size_t ranges = (count + grain - 1) / grain;
  if (ranges == 1) return function(context, 0, count);
  for_each_range(ranges, [=](std::size_t range) {
    const std::size_t begin = range * grain;
    function(context, begin, std::min(begin + grain, count));
  });
}

void on_this_thread(const std::function<void()>& body) {
  tbb::task_arena(1).execute(body);
}

std::size_t allowed_threads() {
  return tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
}

/// Made in its place: a copied tbb::global_control limits nothing.
struct ThreadLimit::Control {
  explicit Control(int threads)
      : limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads)) {}
  Control(const Control&) = delete;
  Control& operator=(const Control&) = delete;

  tbb::global_control limit;
};

ThreadLimit::ThreadLimit(int threads) {
  if (threads > 0) control_ = std::make_unique<Control>(threads);
}

ThreadLimit::~ThreadLimit() = default;

}  // namespace ovimap
