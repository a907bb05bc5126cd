// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/base/stage_timers.h"

#include <gtest/gtest.h>

namespace ovimap {
namespace {

TEST(StageTimers, SummarisesByNearestRank) {
  StageTimers timers;
  for (int i = 100; i >= 1; --i) timers.add("fuse", i);
  const StageSummary summary = timers.summary().at("fuse");
  EXPECT_EQ(summary.p50_ms, 50);
  EXPECT_EQ(summary.p95_ms, 95);
  EXPECT_EQ(summary.p99_ms, 99);
  EXPECT_EQ(summary.total_ms, 5050);
  EXPECT_EQ(summary.count, 100u);
}

TEST(StageTimers, ScopeAddsOneDuration) {
  StageTimers timers;
  { const auto scope = timers.measure("stage"); }
  EXPECT_EQ(timers.summary().at("stage").count, 1u);
}

}  // namespace
}  // namespace ovimap
