// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/base/memory/buffer_pool.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <new>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace ovimap {
namespace {

using Buffer = PooledBuffer<std::uint32_t>;

TEST(BufferPool, AReusedBufferHoldsTheValueThatItIsMadeWith) {
  for (int round = 0; round < 3; ++round) {
    Buffer buffer(100000, 0u);
    for (const std::uint32_t value : buffer) ASSERT_EQ(value, 0u);
    std::fill(buffer.begin(), buffer.end(), 7u);
  }
}

TEST(BufferPool, ServesManyThreadsAndSizes) {
  std::vector<std::thread> threads;
  for (std::uint32_t id = 1; id <= 4; ++id)
    threads.emplace_back([id] {
      for (std::size_t round = 0; round < 200; ++round) {
        const Buffer buffer(20000 + 5000 * (round % 5), id);
        const Buffer copy = buffer;
        for (const std::uint32_t value : copy) ASSERT_EQ(value, id);
      }
    });
  for (std::thread& thread : threads) thread.join();
}

TEST(BufferPool, GivesBackWhatItCannotHold) {
  std::vector<Buffer> buffers;
  for (int i = 0; i < 5; ++i) buffers.emplace_back(std::size_t{5} << 20);  // 20 MiB each
  buffers.clear();
  EXPECT_EQ(Buffer(std::size_t{5} << 20, 3u).data()[12345], 3u);
}

TEST(BufferPool, BuffersAreCopiedMovedAndCompared) {
  Buffer one(100000, 1u);
  Buffer copy = one;
  EXPECT_EQ(copy, one);
  copy.data()[99999] = 2;
  EXPECT_FALSE(copy == one);
  const Buffer moved = std::move(copy);
  EXPECT_EQ(moved.data()[99999], 2u);
  one = moved;
  EXPECT_EQ(one, moved);
  EXPECT_EQ(Buffer(), Buffer(0, 1u));
  EXPECT_THROW((void)Buffer(std::numeric_limits<std::size_t>::max() / 2),
               std::bad_array_new_length);
}

}  // namespace
}  // namespace ovimap
