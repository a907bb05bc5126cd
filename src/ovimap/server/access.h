// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "ovimap/server/http_message.h"

namespace ovimap {

/// Whether only programs on this machine can reach a server bound to `host`.
bool is_loopback(const std::string& host);

/// 32 random hexadecimal digits from the system's source of randomness.
std::string random_token();

/// Who may ask. With a token: whoever shows it, as "Authorization: Bearer", as the cookie that the
/// address with ?token= sets, or in that address. Without: only pages of this server itself. Other
/// web pages in the user's browser are kept out in both cases, also when their name was made to
/// point to this machine.
class AccessRule {
 public:
  explicit AccessRule(std::string token) : token_(std::move(token)) {}

  /// The refusal; nothing when the request may pass.
  std::optional<HttpReply> refusal(const HttpRequest& request) const;

 private:
  bool knows_token(const HttpRequest& request) const;

  std::string token_;
};

/// So many requests a second from one address, after `burst` at once. Thread-safe.
class RateLimit {
 public:
  using Clock = std::chrono::steady_clock;

  RateLimit(double per_second, double burst) : per_second_(per_second), burst_(burst) {}

  bool admits(const std::string& address, Clock::time_point now = Clock::now());

 private:
  static constexpr std::size_t kMostAddresses = 4096;  ///< then those at rest are forgotten

  struct Bucket {
    double left;
    Clock::time_point at;
  };
  double refilled(const Bucket& bucket, Clock::time_point now) const;
  void forget_idle(Clock::time_point now);

  const double per_second_, burst_;
  std::mutex mutex_;
  std::map<std::string, Bucket> buckets_;
};

}  // namespace ovimap
