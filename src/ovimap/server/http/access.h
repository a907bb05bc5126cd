// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "ovimap/server/http/http_message.h"

namespace ovimap {

/// Whether only programs on this machine can reach a server bound to `host`: it is "localhost", in
/// 127/8 or ::1, with or without brackets.
bool is_loopback(const std::string& host);

/// Throws Error unless a token can be sent in a header: printable ASCII, no space at its ends.
void check_token(const std::string& token);

/// Whom limits count as one client: an IPv4 address, or the /64 that an IPv6 address is in, of
/// which anybody has all.
std::string client_of(const std::string& address);

/// 32 random hexadecimal digits from the system's source of randomness.
std::string random_token();

/// Who may ask. With a token: whoever shows it, as "Authorization: Bearer", as the cookie that the
/// address with ?token= sets, or in that address. Without: only those who call this server by a
/// name of this machine, or by one of `host_names`. Other web pages in the user's browser are kept
/// out in both cases, also when their name was made to point to this machine.
class AccessRule {
 public:
  struct Config {
    std::string token;
    std::vector<std::string> host_names;  ///< in any case; none has a port
    bool encrypted = false;               ///< then the cookie is for encrypted connections alone
  };
  explicit AccessRule(Config config) : config_(std::move(config)) {}

  /// The refusal; nothing when the request may pass.
  std::optional<HttpReply> refusal(const HttpRequest& request) const;

 private:
  bool knows_token(const HttpRequest& request) const;
  bool is_called_rightly(const HttpRequest& request) const;

  const Config config_;
};

/// So many requests a second from one client, after `burst` at once. Knows a bounded number of
/// clients: those that asked last. Thread-safe.
class RateLimit {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::size_t kMostClients = 8192;

  RateLimit(double per_second, double burst) : per_second_(per_second), burst_(burst) {}

  bool admits(const std::string& client, Clock::time_point now = Clock::now());
  std::size_t known() const;

 private:
  struct Bucket {
    double left;
    Clock::time_point at;
  };
  using Buckets = std::unordered_map<std::string, Bucket>;
  Bucket& bucket_of(const std::string& client, Clock::time_point now);

  const double per_second_, burst_;
  mutable std::mutex mutex_;
  /// When `recent_` is full, `older_` is forgotten as a whole and takes its place, so that no
  /// request pays for a walk.
  Buckets recent_, older_;
};

}  // namespace ovimap
