// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/base/stage_timers.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ovimap {

namespace {
double percentile(const std::vector<double>& sorted, double fraction) {
  const auto rank =
      static_cast<std::size_t>(std::ceil(fraction * static_cast<double>(sorted.size())));
  return sorted[std::clamp<std::size_t>(rank, 1, sorted.size()) - 1];
}
}  // namespace

void StageTimers::add(std::string_view stage, double milliseconds) {
  auto found = durations_ms_.find(stage);
  if (found == durations_ms_.end()) found = durations_ms_.try_emplace(std::string(stage)).first;
  found->second.push_back(milliseconds);
}

void StageTimers::merge(const StageTimers& other) {
  for (const auto& [stage, durations] : other.durations_ms_) {
    std::vector<double>& own = durations_ms_[stage];
    own.insert(own.end(), durations.begin(), durations.end());
  }
}

std::map<std::string, StageSummary> StageTimers::summary() const {
  std::map<std::string, StageSummary> result;
  for (const auto& [stage, durations] : durations_ms_) {
    std::vector<double> sorted = durations;
    std::sort(sorted.begin(), sorted.end());
    result[stage] = {percentile(sorted, 0.50), percentile(sorted, 0.95), percentile(sorted, 0.99),
                     std::accumulate(sorted.begin(), sorted.end(), 0.0), sorted.size()};
  }
  return result;
}

}  // namespace ovimap
