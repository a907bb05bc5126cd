// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/api/event_stream.h"

#include <charconv>

#include "ovimap/base/error.h"

namespace ovimap {

namespace {

std::uint64_t first_event(const HttpRequest& request, std::uint64_t after) {
  const std::string text = request.header("last-event-id");
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool known = !text.empty() && error == std::errc() && end == text.data() + text.size();
  return known ? number : after;
}

class EventStream : public ReplyStream {
 public:
  EventStream(const EventHub& hub, std::uint64_t last) : hub_(hub), last_(last) {}

  std::string next() override {
    if (!greeted_) {
      greeted_ = true;
      return concat("retry: 2000\nid: ", last_, "\nevent: hello\ndata: {}\n\n");
    }
    const auto event = hub_.next(last_);
    if (!event) return {};
    last_ = event->number;
    return concat("id: ", event->number, "\nevent: ", event->type, "\ndata: ", event->data, "\n\n");
  }
  std::string sign_of_life() const override { return ": quiet\n\n"; }
  bool ended() const override { return hub_.closed(); }
  void watch(std::function<void()> wake) override { watch_ = hub_.watch(std::move(wake)); }

 private:
  const EventHub& hub_;
  std::uint64_t last_;
  bool greeted_ = false;
  std::shared_ptr<void> watch_;
};

}  // namespace

HttpReply event_stream(const EventHub& hub, const HttpRequest& request, std::uint64_t after) {
  HttpReply reply;
  reply.type = "text/event-stream";
  reply.headers["Cache-Control"] = "no-store";
  reply.stream = std::make_shared<EventStream>(hub, first_event(request, after));
  return reply;
}

}  // namespace ovimap
