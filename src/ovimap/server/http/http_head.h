// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <variant>

#include "ovimap/server/http/http_message.h"

namespace ovimap {

// Heads of requests and replies as bytes (RFC 9112).

struct HeadLimits {
  std::size_t bytes = 16 << 10;      ///< of the whole head, its empty line included
  std::size_t line_bytes = 8 << 10;  ///< of the request line
  std::size_t headers = 100;
};

/// The refusal of a head of which so much came without its end; nothing while it may still get
/// one: 414 for an endless first line, 431 for too much in all.
std::optional<HttpReply> refusal_of_unfinished(std::string_view bytes, const HeadLimits& limits);

/// The request whose head is `bytes`, up to and with the empty line; or why it is none, after
/// which the connection ends. Strict where programs that pass requests on could read them in
/// another way: one Host, one Content-Length, whole lines, no folding, no stray bytes, no body in
/// chunks, none with GET and HEAD.
std::variant<HttpRequest, HttpReply> parse_head(std::string_view bytes,
                                                const HeadLimits& limits = {});

/// The text with its %.. replaced; what is no hexadecimal number stays. `plus`: + is a space.
std::string percent_decoded(std::string_view text, bool plus = false);
/// The text with all but letters, digits and -._~ as %.., fit for addresses and cookies.
std::string percent_encoded(std::string_view text);

/// What goes out before the body of a reply.
std::string reply_head(const HttpReply& reply, const HttpRequest& request, bool keep_alive);

}  // namespace ovimap
