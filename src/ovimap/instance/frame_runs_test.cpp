// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/instance/frame_runs.h"

#include <random>
#include <set>

#include <gtest/gtest.h>

namespace ovimap {
namespace {

FrameRuns runs_of(const std::set<std::uint32_t>& frames) {
  FrameRuns runs;
  for (const std::uint32_t frame : frames) runs.add(frame);
  return runs;
}

TEST(FrameRuns, JoinsWhatIsConsecutive) {
  FrameRuns runs;
  for (const std::uint32_t frame : {3u, 4u, 4u, 5u, 9u}) runs.add(frame);
  EXPECT_EQ(runs.runs(), (std::vector<FrameRuns::Run>{{3, 6}, {9, 10}}));
  EXPECT_EQ(runs.count(), 4);
  EXPECT_EQ(FrameRuns().count(), 0);
}

TEST(FrameRuns, UnitesAsSetsDo) {
  std::mt19937 random(7);
  for (int trial = 0; trial < 200; ++trial) {
    std::set<std::uint32_t> a, b;
    for (int i = 0; i < 12; ++i)
      for (auto* set : {&a, &b}) set->insert(static_cast<std::uint32_t>(random() % 30));
    FrameRuns both = runs_of(a);
    both |= runs_of(b);
    a.insert(b.begin(), b.end());
    ASSERT_EQ(both, runs_of(a));
  }
}

}  // namespace
}  // namespace ovimap
