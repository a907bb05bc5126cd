// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/request_desk.h"

#include <xxhash.h>

#include <cstdio>

#include "ovimap/server/compression.h"
#include "ovimap/server/map_api.h"

namespace ovimap {

namespace {

constexpr std::size_t kLongestPath = 1024;     // bytes, decoded
constexpr std::size_t kSmallestPacked = 1024;  // bytes; below, compression saves no packet

HttpReply too_many(const char* what) {
  HttpReply reply =
      fault(429, std::string("too many ") + what + " from this address; wait a second");
  reply.headers.emplace("Retry-After", "1");
  return reply;
}

std::string entity_tag(const std::string& body) {
  char text[24];
  std::snprintf(text, sizeof text, "W/\"%016llx\"",
                static_cast<unsigned long long>(XXH3_64bits(body.data(), body.size())));
  return text;
}

/// Replaces a body that the client has already by "304 Not Modified".
void tag(const HttpRequest& request, HttpReply& reply) {
  if (reply.status != 200 || reply.stream || (request.method != "GET" && request.method != "HEAD"))
    return;
  const std::string etag = entity_tag(*reply.body);
  reply.headers["ETag"] = etag;
  reply.headers.try_emplace("Cache-Control", "no-cache");
  if (request.header("if-none-match").find(etag) == std::string::npos) return;
  reply.status = 304;
  reply.body = std::make_shared<std::string>();
}

void compress(const HttpRequest& request, HttpReply& reply) {
  if (reply.stream || reply.type.starts_with("image/")) return;
  reply.headers["Vary"] = "Accept-Encoding";
  const std::string encoding = choose_encoding(request.header("accept-encoding"));
  if (encoding.empty() || reply.body->size() < kSmallestPacked) return;
  reply.body = std::make_shared<std::string>(compressed(*reply.body, encoding));
  reply.headers["Content-Encoding"] = encoding;
}

/// No page but our own may use what we send, and our page uses nothing from elsewhere.
void protect(HttpReply& reply) {
  reply.headers["X-Content-Type-Options"] = "nosniff";
  reply.headers["Referrer-Policy"] = "no-referrer";
  reply.headers["Cross-Origin-Resource-Policy"] = "same-origin";
  reply.headers["Content-Security-Policy"] =
      "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; "
      "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
}

}  // namespace

RequestDesk::RequestDesk(ServedMap& map, const ServerConfig& config)
    : config_(config),
      access_(config.token),
      files_(config.viewer),
      api_(map_api(map)),
      requests_(config.requests_per_second, config.request_burst),
      work_(config.work_per_second, config.work_burst) {}

HttpReply RequestDesk::answer(const HttpRequest& request) {
  HttpReply reply = find_reply(request);
  tag(request, reply);
  compress(request, reply);
  protect(reply);
  return reply;
}

HttpReply RequestDesk::find_reply(const HttpRequest& request) {
  if (!requests_.admits(request.remote_address)) return too_many("requests");
  if (request.path.size() > kLongestPath)
    return fault(414, "the address is too long; /api/openapi.json says what there is");
  if (auto refusal = access_.refusal(request)) return *refusal;
  if (request.method == "GET" || request.method == "HEAD")
    if (auto file = files_.find(request.path)) return *file;
  if (request.method == "POST" && !work_.admits(request.remote_address))
    return too_many("queries or corrections");
  HttpReply reply = api_.answer(request);
  return reply.stream ? counted_stream(std::move(reply)) : reply;
}

HttpReply RequestDesk::counted_stream(HttpReply reply) {
  struct Place {  // given back when the last copy of the stream goes
    std::shared_ptr<std::atomic<int>> streams;
    explicit Place(std::shared_ptr<std::atomic<int>> all) : streams(std::move(all)) { ++*streams; }
    ~Place() { --*streams; }
  };
  auto place = std::make_shared<Place>(streams_);
  if (*streams_ > config_.max_event_streams)
    return fault(503, "too many clients listen for events; close some of the map's pages");
  reply.stream = [place, inner = std::move(reply.stream)](bool& ended) { return inner(ended); };
  return reply;
}

}  // namespace ovimap
