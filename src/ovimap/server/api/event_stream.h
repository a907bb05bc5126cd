// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/server/http/http_message.h"
#include "ovimap/server/served/event_hub.h"

namespace ovimap {

/// A stream of server-sent events (WHATWG HTML, section 9.2). A client that comes back with
/// Last-Event-ID gets what it missed. When nothing happens a comment goes out now and then, by
/// which vanished clients are noticed. `hub` must outlive the stream.
HttpReply event_stream(const EventHub& hub, const HttpRequest& request);

}  // namespace ovimap
