// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/request_desk.h"

#include <xxhash.h>

#include <charconv>
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

HttpReply too_large() {
  return fault(413, "the request's body is too large");
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

RequestDesk::RequestDesk(ServedMap& map, const ServerConfig& config, FrameIntake* intake)
    : config_(config),
      access_(config.token),
      files_(config.viewer),
      frames_(intake, config.frames),
      api_(map_api(map, frames_)),
      requests_(config.requests_per_second, config.request_burst),
      work_(config.work_per_second, config.work_burst) {}

std::size_t RequestDesk::most_bytes(const HttpRequest& request) const {
  const bool large = frames_.takes_frames() && request.path == FrameApi::kFrames;
  return large ? config_.max_frame_bytes : config_.max_body_bytes;
}

std::optional<HttpReply> RequestDesk::early_refusal(const HttpRequest& head) const {
  const std::string given = head.header("content-length");
  if (given.empty()) return std::nullopt;
  std::size_t bytes = 0;
  const char* end = given.data() + given.size();
  const auto [last, error] = std::from_chars(given.data(), end, bytes);
  std::optional<HttpReply> refused;
  if (error == std::errc::result_out_of_range)
    refused = too_large();
  else if (error != std::errc() || last != end)
    refused = fault(400, "Content-Length must be a whole number");
  else if (bytes <= config_.max_body_bytes)
    return std::nullopt;
  else
    refused = access_.refusal(head);
  if (!refused && bytes > most_bytes(head)) refused = too_large();
  if (!refused) return std::nullopt;
  refused->ends_connection = true;  // the body is still on its way
  protect(*refused);
  return refused;
}

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
  std::size_t bytes = request.body.size();
  for (const auto& [name, content] : request.parts) bytes += content.size();
  if (bytes > most_bytes(request)) return too_large();
  // A camera's frames are held back by the queue that they go into.
  const bool is_frame = frames_.takes_frames() && request.path == FrameApi::kFrames;
  if (request.method == "POST" && !is_frame && !work_.admits(request.remote_address))
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
