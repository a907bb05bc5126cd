// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/front/request_desk.h"

#include <xxhash.h>

#include <cstdio>

#include "ovimap/server/api/map_api.h"
#include "ovimap/server/http/compression.h"

namespace ovimap {

namespace {

constexpr std::size_t kLongestPath = 1024;     // bytes, decoded
constexpr std::size_t kSmallestPacked = 1024;  // bytes; below, compression saves no packet
// Bodies of full length that are read at once, from all and from one client.
constexpr std::size_t kBodiesAtOnce = 64, kBodiesOfOne = 16;

HttpReply too_many(const char* what) {
  HttpReply reply =
      fault(429, std::string("too many ") + what + " from this address; wait a second");
  reply.headers.emplace("Retry-After", "1");
  return reply;
}

HttpReply busy(const char* sentence) {
  HttpReply reply = fault(503, sentence);
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
      access_({config.token, config.host_names, config.encrypted()}),
      files_(config.viewer),
      frames_(intake, config.frames, config.moves_frames),
      standing_(map, {config.max_standing_queries, config.max_standing_queries_of_one}),
      api_(map_api(map, frames_, standing_)),
      requests_(config.requests_per_second, config.request_burst),
      work_(config.work_per_second, config.work_burst),
      streams_(config.max_event_streams, config.max_event_streams_of_one),
      body_bytes_(kBodiesAtOnce * config.max_body_bytes, kBodiesOfOne * config.max_body_bytes),
      frame_bytes_(2 * config.max_frame_bytes, config.max_frame_bytes) {}

RequestDesk::Decision RequestDesk::early(const HttpRequest& head) {
  Decision decision = find_decision(head);
  if (decision.refusal) decision.refusal = refused(std::move(*decision.refusal));
  return decision;
}

HttpReply RequestDesk::refused(HttpReply reply) {
  protect(reply);
  return reply;
}

RequestDesk::Decision RequestDesk::find_decision(const HttpRequest& head) {
  if (!requests_.admits(client_of(head.remote_address))) return {too_many("requests"), true};
  if (head.path.size() > kLongestPath)
    return {fault(414, "the address is too long; /api/openapi.json says what there is")};
  if (auto refusal = access_.refusal(head)) return {std::move(refusal)};
  const std::string coding = head.header("content-encoding");
  if (!coding.empty() && coding != "identity")
    return {fault(415, "bodies are taken as they are, not as Content-Encoding: " + coding)};
  if ((head.method == "GET" || head.method == "HEAD") && files_.find(head.path)) return {};
  const Router::Match match = api_.find(head);
  if (!match.route) return {match.refusal};
  if (auto refusal = misfit(head, match.route->body)) return {std::move(refusal)};
  Decision decision;
  decision.refusal = shortage(head, *match.route, decision.place);
  decision.reads_on = true;
  decision.cost = match.route->cost;
  return decision;
}

/// Why a body of that length and type is not taken, whenever it is sent.
std::optional<HttpReply> RequestDesk::misfit(const HttpRequest& head, BodyType body) const {
  if (!head.content_length && body != BodyType::kNone) {
    HttpReply reply = fault(411, "say how long the body is: Content-Length");
    reply.ends_connection = true;  // a body that does not say so may follow
    return reply;
  }
  const std::uint64_t bytes = head.content_length.value_or(0);
  const bool frame = body == BodyType::kFrame && frames_.takes_frames();
  if (bytes > (frame ? config_.max_frame_bytes : config_.max_body_bytes))
    return fault(413, "the request's body is too large");
  const std::string type = head.header("content-type");
  if (body == BodyType::kFrame && !type.starts_with("multipart/form-data"))
    return fault(415, "send a frame as Content-Type: multipart/form-data");
  const bool sends_json = body == BodyType::kJson || (body == BodyType::kNone && bytes > 0);
  if (sends_json && !type.starts_with("application/json"))
    return fault(415, "send the body as Content-Type: application/json");
  return std::nullopt;
}

/// Why a sound request must come again later.
std::optional<HttpReply> RequestDesk::shortage(const HttpRequest& head, const Route& route,
                                               std::shared_ptr<void>& place) {
  const std::string client = client_of(head.remote_address);
  // A camera's frames are held back by the queue that they go into.
  const bool frame = route.cost == RouteCost::kFrame && frames_.takes_frames();
  const bool reads = route.cost == RouteCost::kLittle || route.cost == RouteCost::kLarge;
  if (!frame && !reads && !work_.admits(client)) return too_many("queries or corrections");
  place = (frame ? frame_bytes_ : body_bytes_).take(client, head.content_length.value_or(0));
  if (!place) return busy("too many bodies are on their way; send this one again");
  return frame ? frames_.early_refusal(head) : std::nullopt;
}

HttpReply RequestDesk::answer(const HttpRequest& request) {
  HttpReply reply = find_reply(request);
  tag(request, reply);
  compress(request, reply);
  protect(reply);
  return reply;
}

void RequestDesk::compress(const HttpRequest& request, HttpReply& reply) {
  if (reply.stream) return;
  std::string encoding;
  if (!reply.type.starts_with("image/")) {
    reply.headers["Vary"] = "Accept-Encoding";
    encoding = choose_encoding(request.header("accept-encoding"));
  }
  if (reply.body->size() < kSmallestPacked) return;
  if (!encoding.empty()) reply.headers["Content-Encoding"] = encoding;
  const auto make = [&]() -> SentBodies::Body {
    if (encoding.empty()) return reply.body;
    return std::make_shared<std::string>(compressed(*reply.body, encoding));
  };
  const auto etag = reply.headers.find("ETag");
  reply.body = etag == reply.headers.end() ? make() : sent_.share(etag->second + encoding, make);
}

HttpReply RequestDesk::find_reply(const HttpRequest& request) {
  if (request.method == "GET" || request.method == "HEAD")
    if (auto file = files_.find(request.path)) return *file;
  Router::Match match = api_.find(request);
  if (!match.route) return match.refusal;
  HttpReply reply;
  if (match.segments.empty()) {
    reply = match.route->handler(request);
  } else {
    HttpRequest filled = request;
    filled.segments = std::move(match.segments);
    reply = match.route->handler(filled);
  }
  return reply.stream ? counted_stream(request, std::move(reply)) : reply;
}

HttpReply RequestDesk::counted_stream(const HttpRequest& request, HttpReply reply) {
  reply.place = streams_.take(client_of(request.remote_address), 1);
  if (!reply.place)
    return fault(503, "too many clients listen for events; close some of the map's pages");
  return reply;
}

}  // namespace ovimap
