// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/server/http/http_message.h"
#include "ovimap/server/served/event_hub.h"

namespace ovimap {

/// A stream of server-sent events (WHATWG HTML, section 9.2). It begins with what came
/// after event number `after`, or after Last-Event-ID for a client that comes back. When nothing
/// happens a comment goes out now and then, by which vanished clients are noticed. `hub` must
/// outlive the stream.
HttpReply event_stream(const EventHub& hub, const HttpRequest& request, std::uint64_t after);

}  // namespace ovimap
