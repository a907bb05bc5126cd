// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/served/event_hub.h"

namespace ovimap {

void EventHub::publish(const std::string& type, const std::string& data) {
  const std::lock_guard lock(mutex_);
  events_.push_back({++last_, type, data});
  if (events_.size() > kKept) events_.pop_front();
  wake_all();
}

void EventHub::wake_all() const {
  for (const auto& [number, wake] : watchers_) wake();
}

std::shared_ptr<void> EventHub::watch(std::function<void()> wake) const {
  const std::lock_guard lock(mutex_);
  const std::uint64_t number = ++watches_;
  watchers_.emplace(number, std::move(wake));
  return {nullptr, [this, number](void*) {
            const std::lock_guard lock_again(mutex_);
            watchers_.erase(number);
          }};
}

std::optional<ServerEvent> EventHub::next(std::uint64_t last) const {
  const std::lock_guard lock(mutex_);
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
  const std::lock_guard lock(mutex_);
  closed_ = true;
  wake_all();
}

bool EventHub::closed() const {
  const std::lock_guard lock(mutex_);
  return closed_;
}

}  // namespace ovimap
