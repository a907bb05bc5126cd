// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <string>

namespace ovimap {

struct ServerEvent {
  std::uint64_t number = 0;  ///< 1, 2, ...
  std::string type;          ///< "map", "mesh", "search"
  std::string data;          ///< JSON
};

/// Hands events from the map to every client that listens. Thread-safe. Writing never waits for a
/// reader: one that falls far behind gets a "reset", after which it should ask for everything anew.
class EventHub {
 public:
  static constexpr std::size_t kKept = 256;

  void publish(const std::string& type, const std::string& data);
  /// The event after number `last`, waited for at most `patience`. Nothing: it got quiet, or the
  /// hub is closed.
  std::optional<ServerEvent> next(std::uint64_t last, std::chrono::milliseconds patience) const;
  std::uint64_t last() const;
  /// Ends all waiting, for good.
  void close();
  bool closed() const;

 private:
  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  std::deque<ServerEvent> events_;
  std::uint64_t last_ = 0;
  bool closed_ = false;
};

}  // namespace ovimap
