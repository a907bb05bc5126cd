// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>

namespace ovimap {

/// Bodies of replies that are being sent: many clients that ask for one thing hold it once, however
/// slowly they read. Thread-safe.
class SentBodies {
 public:
  using Body = std::shared_ptr<const std::string>;

  /// The body known by `key` that somebody still holds, or the one that `make` gives.
  Body share(const std::string& key, const std::function<Body()>& make);

 private:
  std::mutex mutex_;
  std::map<std::string, std::weak_ptr<const std::string>> bodies_;
  std::size_t most_ = 256;  ///< then those that nobody holds are forgotten
};

}  // namespace ovimap
