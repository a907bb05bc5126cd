// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace ovimap {

struct StageSummary {
  double p50_ms = 0, p95_ms = 0, p99_ms = 0, total_ms = 0;
  std::size_t count = 0;
};

/// Wall-clock durations by stage name, on the steady clock. One writer thread.
class StageTimers {
 public:
  /// Measures from construction to destruction.
  class Scope {
   public:
    Scope(StageTimers& timers, std::string_view stage)
        : timers_(timers), stage_(stage), start_(std::chrono::steady_clock::now()) {}
    ~Scope() {
      const std::chrono::duration<double, std::milli> elapsed =
          std::chrono::steady_clock::now() - start_;
      timers_.add(stage_, elapsed.count());
    }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    StageTimers& timers_;
    std::string_view stage_;
    std::chrono::steady_clock::time_point start_;
  };

  [[nodiscard]] Scope measure(std::string_view stage) { return Scope(*this, stage); }
  void add(std::string_view stage, double milliseconds);
  /// Adds all that another has measured.
  void merge(const StageTimers& other);

  /// Percentiles by nearest rank, per stage.
  std::map<std::string, StageSummary> summary() const;

 private:
  std::map<std::string, std::vector<double>, std::less<>> durations_ms_;
};

}  // namespace ovimap
