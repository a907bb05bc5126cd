// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/http/worker_pool.h"

#include <algorithm>

namespace ovimap {

WorkerPool::WorkerPool(int threads, std::size_t most_waiting, int most_of_one)
    : most_waiting_(most_waiting), most_of_one_(most_of_one) {
  for (int i = 0; i < threads; ++i) threads_.emplace_back([this] { work(); });
}

WorkerPool::~WorkerPool() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

bool WorkerPool::offer(const std::string& client, Job job) {
  {
    const std::lock_guard lock(mutex_);
    if (waiting_ >= most_waiting_) return false;
    auto& jobs = jobs_of_[client];
    if (jobs.empty()) turns_.push_back(client);
    jobs.push_back(std::move(job));
    ++waiting_;
  }
  changed_.notify_one();
  return true;
}

/// Of the first client that may have another thread; the end where there is none.
std::deque<std::string>::iterator WorkerPool::next_turn() {
  return std::find_if(turns_.begin(), turns_.end(), [this](const std::string& client) {
    const auto working = threads_of_.find(client);
    return working == threads_of_.end() || working->second < most_of_one_;
  });
}

WorkerPool::Turn WorkerPool::take(std::deque<std::string>::iterator turn) {
  std::string client = std::move(*turn);
  turns_.erase(turn);
  const auto jobs = jobs_of_.find(client);
  Job job = std::move(jobs->second.front());
  jobs->second.pop_front();
  --waiting_;
  ++threads_of_[client];
  if (jobs->second.empty())
    jobs_of_.erase(jobs);
  else
    turns_.push_back(client);
  return {std::move(client), std::move(job)};
}

void WorkerPool::work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return ending_ || next_turn() != turns_.end(); });
    if (ending_) return;
    Turn turn = take(next_turn());
    lock.unlock();
    turn.job();
    turn.job = nullptr;  // what it holds goes without the lock
    lock.lock();
    if (--threads_of_[turn.client] == 0) threads_of_.erase(turn.client);
  }
}

}  // namespace ovimap
