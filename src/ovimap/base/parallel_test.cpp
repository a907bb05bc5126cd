// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/base/parallel.h"

#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace ovimap {
namespace {

TEST(ParallelFor, VisitsEveryIndexOnce) {
  std::vector<int> visits(1001, 0);
  parallel_for(visits.size(), 10, [&](std::size_t i) { ++visits[i]; });
  EXPECT_EQ(visits, std::vector<int>(1001, 1));
}

TEST(ParallelFor, CutsRangesTheSameForAnyThreadCount) {
  const auto cuts = [](int threads) {
    ThreadLimit limit(threads);
    std::vector<std::size_t> end_of(103, 0);
    parallel_for_ranges(end_of.size(), 10,
                        [&](std::size_t begin, std::size_t end) { end_of[begin] = end; });
    return end_of;
  };
  EXPECT_EQ(cuts(1), cuts(2));
  EXPECT_EQ(cuts(1)[100], 103u);
}

TEST(ParallelFor, HandsExceptionsToTheCaller) {
  EXPECT_THROW(parallel_for(100, 1,
                            [](std::size_t i) {
                              if (i == 57) throw std::runtime_error("57");
                            }),
               std::runtime_error);
}

TEST(ParallelFor, DoesNothingForNothing) {
  parallel_for(0, 1, [](std::size_t) { FAIL(); });
}

TEST(ThreadLimit, SaysHowManyThreadsMayRun) {
  const std::size_t before = allowed_threads();
  EXPECT_GE(before, 1u);
  {
    const ThreadLimit one(1);
    EXPECT_EQ(allowed_threads(), 1u);
  }
  EXPECT_EQ(allowed_threads(), before);
}

#ifndef __SANITIZE_THREAD__  // under which parallel_for takes threads of its own
TEST(OnThisThread, NoOtherThreadHelps) {
  std::vector<std::thread::id> workers(64);
  on_this_thread([&] {
    parallel_for(workers.size(), 1,
                 [&](std::size_t i) { workers[i] = std::this_thread::get_id(); });
  });
  EXPECT_EQ(workers, std::vector<std::thread::id>(64, std::this_thread::get_id()));
}
#endif

}  // namespace
}  // namespace ovimap
