// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/base/parallel.h"

#include <algorithm>

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

namespace ovimap {

void detail::parallel_ranges(std::size_t count, std::size_t grain, void* context,
                             RangeFunction function) {
  if (count == 0) return;
  grain = std::max<std::size_t>(grain, 1);
  const std::size_t ranges = (count + grain - 1) / grain;
  if (ranges == 1) return function(context, 0, count);
  tbb::parallel_for(std::size_t{0}, ranges, [=](std::size_t range) {
    const std::size_t begin = range * grain;
    function(context, begin, std::min(begin + grain, count));
  });
}

struct ThreadLimit::Control {
  tbb::global_control limit;
};

ThreadLimit::ThreadLimit(int threads) {
  if (threads > 0) {
    control_ = std::make_unique<Control>(Control{tbb::global_control(
        tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads))});
  }
}

ThreadLimit::~ThreadLimit() = default;

}  // namespace ovimap
