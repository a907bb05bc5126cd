// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/instance/frame_runs.h"

#include <algorithm>
#include <iterator>

namespace ovimap {

void FrameRuns::add(std::uint32_t frame) {
  if (runs_.empty() || frame > runs_.back().end)
    runs_.push_back({frame, frame + 1});
  else
    runs_.back().end = frame + 1;
}

FrameRuns& FrameRuns::operator|=(const FrameRuns& other) {
  std::vector<Run> all;
  std::merge(runs_.begin(), runs_.end(), other.runs_.begin(), other.runs_.end(),
             std::back_inserter(all), [](const Run& a, const Run& b) { return a.begin < b.begin; });
  runs_.clear();
  for (const Run& run : all) {
    if (runs_.empty() || run.begin > runs_.back().end)
      runs_.push_back(run);
    else
      runs_.back().end = std::max(runs_.back().end, run.end);
  }
  return *this;
}

int FrameRuns::count() const {
  std::uint32_t frames = 0;
  for (const Run& run : runs_) frames += run.end - run.begin;
  return static_cast<int>(frames);
}

}  // namespace ovimap
