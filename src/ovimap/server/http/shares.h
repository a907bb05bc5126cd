// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <string>

namespace ovimap {

/// So much of something in all, and so much of it for one client: places of listeners, bytes of
/// bodies. Thread-safe.
class Shares {
 public:
  Shares(std::size_t all, std::size_t of_one);

  /// The client's hold on so much, until the last copy goes, which may outlive this object; null
  /// when that is too much.
  std::shared_ptr<void> take(const std::string& client, std::size_t amount);

 private:
  struct Ledger {
    std::mutex mutex;
    std::size_t taken = 0;
    std::map<std::string, std::size_t> of_client;
  };
  const std::size_t all_, of_one_;
  const std::shared_ptr<Ledger> ledger_ = std::make_shared<Ledger>();
};

}  // namespace ovimap
