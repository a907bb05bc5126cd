// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace ovimap {

/// A few threads that do what must not hold up the sockets. Clients take turns, a job a turn, so
/// that nobody waits for more than one job of each other client. Thread-safe.
class WorkerPool {
 public:
  /// `most_of_one`: so many threads at most work for one client.
  WorkerPool(int threads, std::size_t most_waiting, int most_of_one);
  /// Waits for the jobs under way; those that nobody has begun are dropped.
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  /// False, and nothing happens, when too many jobs wait. A job must not throw.
  bool offer(const std::string& client, std::function<void()> job);

 private:
  using Job = std::function<void()>;
  struct Turn {
    std::string client;
    Job job;
  };

  void work();
  std::deque<std::string>::iterator next_turn();
  Turn take(std::deque<std::string>::iterator turn);

  const std::size_t most_waiting_;
  const int most_of_one_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::string, std::deque<Job>> jobs_of_;  ///< of the clients that have any
  std::deque<std::string> turns_;                   ///< these clients, the next one first
  std::map<std::string, int> threads_of_;           ///< that work for a client
  std::size_t waiting_ = 0;                         ///< jobs of all
  bool ending_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace ovimap
