// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "ovimap/server/http/shares.h"
#include "ovimap/server/served/served_map.h"
#include "ovimap/server/served/standing_watch.h"

namespace ovimap {

/// Asks a map for all standing queries of all clients whenever it changed, from a thread of its own
/// that takes a twentieth of the time at most, unless that made it slower than one round in ten
/// seconds. A text that several clients watch for is asked once. Thread-safe.
class StandingQueries {
 public:
  struct Limits {
    std::size_t all = 4000,
                of_one = 2000;  ///< queries that stand at once, of all clients and of one
  };
  /// `map` must outlive this.
  StandingQueries(const ServedMap& map, const Limits& limits);
  ~StandingQueries();
  StandingQueries(const StandingQueries&) = delete;
  StandingQueries& operator=(const StandingQueries&) = delete;

  /// The client's queries, watched until the result goes, which may outlive this; null where that
  /// is more than may stand at once. `mark`: of an earlier watch for the same
  /// (StandingWatch::mark).
  std::shared_ptr<StandingWatch> watch(std::vector<std::string> queries,
                                       StandingWatch::Clock::duration hold, const std::string& mark,
                                       const std::string& client);

 private:
  using Clock = StandingWatch::Clock;
  using Watches = std::vector<std::shared_ptr<StandingWatch>>;
  struct Asked {
    std::uint64_t version = 0;  ///< of the map
    StandingVerdict verdict;
  };

  void work();
  void look(const Watches& watches);
  /// The verdict on `text` by the map of now. Throws SearchUnavailable.
  Asked ask(const std::string& text) const;
  void ask_all(const Watches& watches, bool all);
  Watches living();

  const ServedMap& map_;
  Shares places_;

  std::mutex mutex_;  ///< guards what follows; held for a moment only
  std::condition_variable changed_;
  std::vector<std::weak_ptr<StandingWatch>> watches_;
  bool news_ = false;
  std::atomic<bool> ending_ = false;

  // The thread's.
  std::map<std::string, Asked> asked_;
  std::uint64_t looked_at_ = 0;  ///< state of the map in which all was asked last
  Clock::time_point rest_until_;

  std::shared_ptr<void> listening_;
  std::thread thread_;
};

}  // namespace ovimap
