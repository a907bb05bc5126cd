// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/http/sent_bodies.h"

#include <algorithm>

namespace ovimap {

SentBodies::Body SentBodies::share(const std::string& key, const std::function<Body()>& make) {
  {
    const std::lock_guard lock(mutex_);
    if (const auto found = bodies_.find(key); found != bodies_.end())
      if (Body body = found->second.lock()) return body;
  }
  Body fresh = make();
  const std::lock_guard lock(mutex_);
  if (bodies_.size() >= most_) {
    std::erase_if(bodies_, [](const auto& entry) { return entry.second.expired(); });
    most_ = std::max<std::size_t>(256, 2 * bodies_.size());  // so that it is seldom
  }
  auto& known = bodies_[key];
  if (Body body = known.lock()) return body;  // another was faster
  known = fresh;
  return fresh;
}

}  // namespace ovimap
