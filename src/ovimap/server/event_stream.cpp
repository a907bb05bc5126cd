// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/event_stream.h"

#include <charconv>

#include "ovimap/base/error.h"

namespace ovimap {

namespace {

constexpr std::chrono::seconds kHeartbeat{5};

std::uint64_t first_event(const EventHub& hub, const HttpRequest& request) {
  const std::string text = request.header("last-event-id");
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool known = !text.empty() && error == std::errc() && end == text.data() + text.size();
  return known ? number : hub.last();
}

}  // namespace

HttpReply event_stream(const EventHub& hub, const HttpRequest& request) {
  HttpReply reply;
  reply.type = "text/event-stream";
  reply.headers["Cache-Control"] = "no-store";
  reply.stream = [&hub, last = first_event(hub, request), greeted = false](bool& ended) mutable {
    if (!greeted) {
      greeted = true;
      return concat("retry: 2000\nid: ", last, "\nevent: hello\ndata: {}\n\n");
    }
    const auto event = hub.next(last, kHeartbeat);
    ended = hub.closed();
    if (!event) return std::string(": quiet\n\n");
    last = event->number;
    return concat("id: ", event->number, "\nevent: ", event->type, "\ndata: ", event->data, "\n\n");
  };
  return reply;
}

}  // namespace ovimap
