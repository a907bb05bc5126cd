// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/http/worker_pool.h"

namespace ovimap {

WorkerPool::WorkerPool(int threads, std::size_t most_waiting) : most_waiting_(most_waiting) {
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

WorkerPool::Job WorkerPool::take_next() {
  std::string client = std::move(turns_.front());
  turns_.pop_front();
  const auto jobs = jobs_of_.find(client);
  Job job = std::move(jobs->second.front());
  jobs->second.pop_front();
  --waiting_;
  if (jobs->second.empty())
    jobs_of_.erase(jobs);
  else
    turns_.push_back(std::move(client));
  return job;
}

void WorkerPool::work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return ending_ || waiting_ > 0; });
    if (ending_) return;
    Job job = take_next();
    lock.unlock();
    job();
    job = nullptr;  // what it holds goes without the lock
    lock.lock();
  }
}

}  // namespace ovimap
