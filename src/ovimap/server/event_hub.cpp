// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/event_hub.h"

namespace ovimap {

void EventHub::publish(const std::string& type, const std::string& data) {
  {
    const std::lock_guard lock(mutex_);
    events_.push_back({++last_, type, data});
    if (events_.size() > kKept) events_.pop_front();
  }
  changed_.notify_all();
}

std::optional<ServerEvent> EventHub::next(std::uint64_t last,
                                          std::chrono::milliseconds patience) const {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, patience, [&] { return closed_ || last_ != last; });
  if (closed_ || last_ == last) return std::nullopt;
  // A number from before a restart of the server is ahead of ours.
  if (last > last_ || events_.front().number > last + 1) return ServerEvent{last_, "reset", "{}"};
  return events_[static_cast<std::size_t>(last + 1 - events_.front().number)];
}

std::uint64_t EventHub::last() const {
  const std::lock_guard lock(mutex_);
  return last_;
}

void EventHub::close() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  changed_.notify_all();
}

bool EventHub::closed() const {
  const std::lock_guard lock(mutex_);
  return closed_;
}

}  // namespace ovimap
