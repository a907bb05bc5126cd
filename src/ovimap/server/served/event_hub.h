// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

namespace ovimap {

struct ServerEvent {
  std::uint64_t number = 0;  ///< 1, 2, ...
  std::string type;          ///< "map", "mesh", "search"
  std::string data;          ///< JSON
};

/// Hands events from the map to every client that listens. Thread-safe. Nobody
/// waits: a reader is woken, and one that falls far behind gets a "reset", after which it should
/// ask for everything anew.
class EventHub {
 public:
  static constexpr std::size_t kKept = 256;

  void publish(const std::string& type, const std::string& data);
  /// The event after number `last`. Nothing: there is none yet, or the hub is closed.
  std::optional<ServerEvent> next(std::uint64_t last) const;
  /// Calls `wake` for each event and at the end, from the thread that publishes and until the
  /// result goes, which must be before this hub. `wake` must not wait, nor use the hub.
  std::shared_ptr<void> watch(std::function<void()> wake) const;
  std::uint64_t last() const;
  /// No more events are given.
  void close();
  bool closed() const;

 private:
  void wake_all() const;  // under the mutex: who is woken has not left in the meantime

  mutable std::mutex mutex_;
  mutable std::map<std::uint64_t, std::function<void()>> watchers_;
  mutable std::uint64_t watches_ = 0;
  std::deque<ServerEvent> events_;
  std::uint64_t last_ = 0;
  bool closed_ = false;
};

}  // namespace ovimap
