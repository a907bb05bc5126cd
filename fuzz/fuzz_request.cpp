// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// Heads of requests, and who is let in by them.
#include <string>
#include <variant>

#include "ovimap/server/http/access.h"
#include "ovimap/server/http/http_head.h"

namespace {

/// Whether the text is made of nothing but `letters`, and not empty.
bool consists_of(const std::string& text, const char* letters) {
  return !text.empty() && text.find_first_not_of(letters) == std::string::npos;
}

/// A name of this machine with at most a port, told by other means than the server's.
bool is_of_this_machine(std::string host) {
  const std::size_t colon = host.rfind(':');
  if (colon != std::string::npos && !host.ends_with(']')) {
    if (!consists_of(host.substr(colon + 1), "0123456789")) return false;
    host.resize(colon);
  }
  for (char& letter : host)
    if (letter >= 'A' && letter <= 'Z') letter = static_cast<char>(letter - 'A' + 'a');
  return host == "localhost" || (host.starts_with("127.") && consists_of(host, "0123456789.")) ||
         (host.starts_with('[') && host.ends_with(']') &&
          consists_of(host, "[]0123456789abcdef:."));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string head(reinterpret_cast<const char*>(data), size);
  (void)ovimap::refusal_of_unfinished(head, {});
  const auto parsed = ovimap::parse_head(head);
  if (const auto* refusal = std::get_if<ovimap::HttpReply>(&parsed)) {
    if (refusal->status < 400 || !refusal->ends_connection) __builtin_trap();
    return 0;
  }
  const auto& request = std::get<ovimap::HttpRequest>(parsed);
  if (request.method.empty() || !head.starts_with(request.method)) __builtin_trap();
  if (request.headers.contains("transfer-encoding")) __builtin_trap();
  for (const auto& [name, value] : request.headers)
    if (name.find_first_of("\r\n: ") != std::string::npos ||
        value.find_first_of("\r\n") != std::string::npos)
      __builtin_trap();
  const bool admitted = !ovimap::AccessRule({}).refusal(request);
  if (admitted && !is_of_this_machine(request.header("host"))) __builtin_trap();
  const std::string reply = ovimap::reply_head(ovimap::HttpReply{}, request, true);
  if (reply.find("\r\n\r\n") != reply.size() - 4) __builtin_trap();
  return 0;
}
