// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/access.h"

#include <algorithm>
#include <random>

namespace ovimap {

namespace {

constexpr const char* kCookie = "ovimap_token=";

/// "localhost" of "localhost:8080", "[::1]" of "[::1]:8080".
std::string host_of(const std::string& authority) {
  if (authority.starts_with('[')) return authority.substr(0, authority.find(']') + 1);
  return authority.substr(0, authority.find(':'));
}

/// Takes the same time wherever the texts differ, so that a token cannot be guessed letter by
/// letter.
bool same(const std::string& a, const std::string& b) {
  unsigned difference = a.size() == b.size() ? 0u : 1u;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    difference |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]);
  return difference == 0;
}

std::string cookie_token(const std::string& cookies) {
  const std::string name = kCookie;
  for (std::size_t at = 0; at < cookies.size();) {
    const std::size_t end = std::min(cookies.find(';', at), cookies.size());
    const std::size_t first = cookies.find_first_not_of(' ', at);
    if (first < end && cookies.compare(first, name.size(), name) == 0)
      return cookies.substr(first + name.size(), end - first - name.size());
    at = end + 1;
  }
  return {};
}

bool comes_from_other_page(const HttpRequest& request) {
  const std::string origin = request.header("origin");
  if (origin.empty()) return false;
  return origin != "http://" + request.header("host") &&
         origin != "https://" + request.header("host");
}

}  // namespace

bool is_loopback(const std::string& host) {
  return host == "localhost" || host == "::1" || host == "[::1]" || host.starts_with("127.");
}

std::string random_token() {
  std::random_device source;
  std::string token;
  for (int i = 0; i < 32; ++i) token += "0123456789abcdef"[source() % 16];
  return token;
}

bool AccessRule::knows_token(const HttpRequest& request) const {
  const std::string bearer = "Bearer ", authorization = request.header("authorization");
  if (authorization.starts_with(bearer) && same(authorization.substr(bearer.size()), token_))
    return true;
  return same(cookie_token(request.header("cookie")), token_);
}

std::optional<HttpReply> AccessRule::refusal(const HttpRequest& request) const {
  if (comes_from_other_page(request))
    return fault(403, "requests of other web pages are refused; open this server's own address");
  if (token_.empty()) {
    if (is_loopback(host_of(request.header("host")))) return std::nullopt;
    return fault(403, "this server answers to localhost and 127.0.0.1 alone, not to '" +
                          request.header("host") + "'; use one of these");
  }
  if (knows_token(request)) return std::nullopt;
  const auto offered = request.query.find("token");
  if (request.path == "/" && offered != request.query.end() && same(offered->second, token_)) {
    HttpReply reply = text_reply(303, "text/plain", "");
    reply.headers["Location"] = "/";
    reply.headers["Set-Cookie"] = kCookie + token_ + "; Path=/; HttpOnly; SameSite=Strict";
    return reply;
  }
  HttpReply reply = fault(401,
                          "this map is protected by a token; open the whole address that `ovimap "
                          "serve` printed, the part ?token= included");
  reply.headers["WWW-Authenticate"] = "Bearer";
  return reply;
}

double RateLimit::refilled(const Bucket& bucket, Clock::time_point now) const {
  const double seconds = std::chrono::duration<double>(now - bucket.at).count();
  return std::min(burst_, bucket.left + std::max(seconds, 0.0) * per_second_);
}

void RateLimit::forget_idle(Clock::time_point now) {
  std::erase_if(buckets_, [&](const auto& entry) { return refilled(entry.second, now) >= burst_; });
}

bool RateLimit::admits(const std::string& address, Clock::time_point now) {
  const std::lock_guard lock(mutex_);
  if (buckets_.size() >= kMostAddresses) forget_idle(now);
  Bucket& bucket = buckets_.try_emplace(address, Bucket{burst_, now}).first->second;
  bucket = {refilled(bucket, now), now};
  if (bucket.left < 1) return false;
  bucket.left -= 1;
  return true;
}

}  // namespace ovimap
