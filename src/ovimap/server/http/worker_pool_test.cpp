// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/http/worker_pool.h"

#include <gtest/gtest.h>

#include <atomic>
#include <future>

namespace ovimap {
namespace {

TEST(WorkerPoolTest, RefusesWhatWouldWaitTooLong) {
  std::promise<void> begun, go;
  std::atomic<int> done = 0;
  {
    WorkerPool pool(1, 2);
    EXPECT_TRUE(pool.offer([&] {
      begun.set_value();
      go.get_future().wait();
      ++done;
    }));
    begun.get_future().wait();
    for (int i = 0; i < 2; ++i) EXPECT_TRUE(pool.offer([&] { ++done; }));
    EXPECT_FALSE(pool.offer([&] { ++done; }));
    go.set_value();
    while (done < 3) std::this_thread::yield();
  }
  EXPECT_EQ(done, 3);
}

}  // namespace
}  // namespace ovimap
