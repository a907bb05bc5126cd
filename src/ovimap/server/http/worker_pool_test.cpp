// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/http/worker_pool.h"

#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <string>

namespace ovimap {
namespace {

TEST(WorkerPoolTest, RefusesWhatWouldWaitTooLong) {
  std::promise<void> begun, go;
  std::atomic<int> done = 0;
  {
    WorkerPool pool(1, 2, 1);
    EXPECT_TRUE(pool.offer("a", [&] {
      begun.set_value();
      go.get_future().wait();
      ++done;
    }));
    begun.get_future().wait();
    for (int i = 0; i < 2; ++i) EXPECT_TRUE(pool.offer("a", [&] { ++done; }));
    EXPECT_FALSE(pool.offer("b", [&] { ++done; }));
    go.set_value();
    while (done < 3) std::this_thread::yield();
  }
  EXPECT_EQ(done, 3);
}

TEST(WorkerPoolTest, ClientsTakeTurns) {
  std::promise<void> begun, go, all;
  std::string order;
  WorkerPool pool(1, 10, 1);
  EXPECT_TRUE(pool.offer("busy", [&] {
    begun.set_value();
    go.get_future().wait();
  }));
  begun.get_future().wait();
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(pool.offer("busy", [&] { order += 'b'; }));
  EXPECT_TRUE(pool.offer("other", [&] { order += 'o'; }));
  EXPECT_TRUE(pool.offer("busy", [&] { all.set_value(); }));
  go.set_value();
  all.get_future().wait();
  EXPECT_EQ(order, "bobbb");
}

TEST(WorkerPoolTest, OneClientLeavesAThreadToOthers) {
  std::promise<void> go;
  const std::shared_future<void> gone(go.get_future());
  std::promise<void> served;
  std::atomic<int> done = 0;
  {
    WorkerPool pool(2, 10, 1);
    for (int i = 0; i < 3; ++i)
      EXPECT_TRUE(pool.offer("busy", [&] {
        gone.wait();
        ++done;
      }));
    EXPECT_TRUE(pool.offer("other", [&] { served.set_value(); }));
    served.get_future().wait();
    EXPECT_EQ(done, 0);
    go.set_value();
    while (done < 3) std::this_thread::yield();
  }
  EXPECT_EQ(done, 3);
}

}  // namespace
}  // namespace ovimap
