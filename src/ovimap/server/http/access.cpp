// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/http/access.h"

#include <arpa/inet.h>
#include <netinet/in.h>

#include <algorithm>
#include <cctype>
#include <random>
#include <string_view>

#include "ovimap/base/error.h"
#include "ovimap/server/http/http_head.h"

namespace ovimap {

namespace {

constexpr const char* kCookie = "ovimap_token=";

bool same_name(std::string_view a, std::string_view b) {
  const auto lower = [](unsigned char letter) { return std::tolower(letter); };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [&](char x, char y) { return lower(x) == lower(y); });
}

bool is_port(std::string_view text) {
  const auto is_digit = [](char letter) { return letter >= '0' && letter <= '9'; };
  return !text.empty() && text.size() <= 5 && std::all_of(text.begin(), text.end(), is_digit);
}

/// "localhost" of "localhost:8080", "[::1]" of "[::1]:8080"; empty where that is no host with at
/// most a port.
std::string_view host_of(std::string_view authority) {
  const bool six = authority.starts_with('[');
  const std::size_t end = six ? authority.find(']') + 1 : authority.find(':');
  if (six && end == 0) return {};
  const std::string_view host = authority.substr(0, end);
  const std::string_view rest = authority.substr(host.size());
  return rest.empty() || (rest.front() == ':' && is_port(rest.substr(1))) ? host
                                                                          : std::string_view();
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

/// Browsers name the page that asks in Origin, or where they leave that out, as for pictures, say
/// in Sec-Fetch-Site that it is another one's. Whoever follows a link to the page opens it himself.
bool comes_from_other_page(const HttpRequest& request) {
  const std::string origin = request.header("origin"), site = request.header("sec-fetch-site");
  const bool opened = request.path == "/" && request.header("sec-fetch-mode") == "navigate";
  if ((site == "cross-site" || site == "same-site") && !opened) return true;
  if (origin.empty()) return false;
  return origin != "http://" + request.header("host") &&
         origin != "https://" + request.header("host");
}

}  // namespace

bool is_loopback(const std::string& host) {
  if (same_name(host, "localhost")) return true;
  const bool bracketed = host.starts_with('[') && host.ends_with(']');
  in_addr four{};
  if (inet_pton(AF_INET, host.c_str(), &four) == 1) return (ntohl(four.s_addr) >> 24) == 127;
  in6_addr six{};
  const std::string text = bracketed ? host.substr(1, host.size() - 2) : host;
  return inet_pton(AF_INET6, text.c_str(), &six) == 1 && IN6_IS_ADDR_LOOPBACK(&six);
}

void check_token(const std::string& token) {
  const auto is_printable = [](char letter) { return letter >= ' ' && letter <= '~'; };
  if (std::all_of(token.begin(), token.end(), is_printable) && !token.empty() &&
      token.front() != ' ' && token.back() != ' ')
    return;
  throw Error(
      "the token cannot be sent in a header; choose one of printable ASCII characters without "
      "spaces at its ends");
}

std::string client_of(const std::string& address) {
  in6_addr six{};
  if (inet_pton(AF_INET6, address.c_str(), &six) != 1) return address;
  return {reinterpret_cast<const char*>(six.s6_addr), 8};
}

std::string random_token() {
  std::random_device source;
  std::string token;
  for (int i = 0; i < 32; ++i) token += "0123456789abcdef"[source() % 16];
  return token;
}

bool AccessRule::knows_token(const HttpRequest& request) const {
  const std::string bearer = "Bearer ", authorization = request.header("authorization");
  if (authorization.starts_with(bearer) && same(authorization.substr(bearer.size()), config_.token))
    return true;
  return same(percent_decoded(cookie_token(request.header("cookie"))), config_.token);
}

bool AccessRule::is_called_rightly(const HttpRequest& request) const {
  const std::string host(host_of(request.header("host")));
  const auto is_host = [&](const std::string& name) { return same_name(host, name); };
  return is_loopback(host) || (!host.empty() && std::any_of(config_.host_names.begin(),
                                                            config_.host_names.end(), is_host));
}

std::optional<HttpReply> AccessRule::refusal(const HttpRequest& request) const {
  if (comes_from_other_page(request))
    return fault(403, "requests of other web pages are refused; open this server's own address");
  if (config_.token.empty()) {
    if (is_called_rightly(request)) return std::nullopt;
    return fault(403, "this server answers to localhost and 127.0.0.1 alone, not to '" +
                          request.header("host") +
                          "'; use one of these, or start it with --host-name");
  }
  if (knows_token(request)) return std::nullopt;
  const auto offered = request.query.find("token");
  if (request.path == "/" && offered != request.query.end() &&
      same(offered->second, config_.token)) {
    HttpReply reply = text_reply(303, "text/plain", "");
    reply.headers["Location"] = "/";
    reply.headers["Set-Cookie"] = kCookie + percent_encoded(config_.token) +
                                  "; Path=/; HttpOnly; SameSite=Strict" +
                                  (config_.encrypted ? "; Secure" : "");
    return reply;
  }
  HttpReply reply = fault(401,
                          "this map is protected by a token; open the whole address that `ovimap "
                          "serve` printed, the part ?token= included");
  reply.headers["WWW-Authenticate"] = "Bearer";
  return reply;
}

RateLimit::Bucket& RateLimit::bucket_of(const std::string& client, Clock::time_point now) {
  if (const auto found = recent_.find(client); found != recent_.end()) return found->second;
  if (recent_.size() >= kMostClients / 2) {
    older_ = std::move(recent_);
    recent_.clear();
  }
  const auto before = older_.find(client);
  const Bucket bucket = before == older_.end() ? Bucket{burst_, now} : before->second;
  return recent_.emplace(client, bucket).first->second;
}

bool RateLimit::admits(const std::string& client, Clock::time_point now) {
  const std::lock_guard lock(mutex_);
  Bucket& bucket = bucket_of(client, now);
  const double seconds = std::chrono::duration<double>(now - bucket.at).count();
  bucket.left = std::min(burst_, bucket.left + std::max(seconds, 0.0) * per_second_);
  bucket.at = now;
  if (bucket.left < 1) return false;
  bucket.left -= 1;
  return true;
}

std::size_t RateLimit::known() const {
  const std::lock_guard lock(mutex_);
  return recent_.size() + older_.size();
}

}  // namespace ovimap
