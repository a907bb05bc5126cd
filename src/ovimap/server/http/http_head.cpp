// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/http/http_head.h"

#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/status.hpp>

#include <algorithm>
#include <charconv>
#include <limits>

#include "ovimap/base/error.h"
#include "ovimap/base/text/ascii.h"

namespace ovimap {

namespace {

namespace http = boost::beast::http;
using Fields = http::request<http::empty_body>;

HttpReply ending(int status, const std::string& sentence) {
  HttpReply reply = fault(status, sentence);
  reply.ends_connection = true;
  return reply;
}

HttpReply too_long() {
  return ending(414, "the address is too long; /api/openapi.json says what there is");
}

HttpReply too_large(const HeadLimits& limits) {
  return ending(431, concat("the request's head is too large; it may have ", limits.headers,
                            " headers and ", limits.bytes, " bytes"));
}

/// What a parser may take in one way and a proxy before it in another.
bool has_stray_bytes(std::string_view bytes) {
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const auto byte = static_cast<unsigned char>(bytes[i]);
    const bool line_end = byte == '\r' && i + 1 < bytes.size() && bytes[i + 1] == '\n';
    if (line_end) {
      ++i;
      const bool folded = i + 1 < bytes.size() && (bytes[i + 1] == ' ' || bytes[i + 1] == '\t');
      if (folded) return true;
    } else if ((byte < 0x20 && byte != '\t') || byte == 0x7f) {
      return true;
    }
  }
  return false;
}

std::size_t count_headers(std::string_view bytes) {
  const auto lines = static_cast<std::size_t>(std::count(bytes.begin(), bytes.end(), '\n'));
  return lines - std::min<std::size_t>(lines, 2);  // the request line, the empty line
}

HttpReply refusal_of(const boost::system::error_code& error) {
  if (error == http::error::bad_version)
    return ending(505, "the server speaks HTTP/1.1 and HTTP/1.0");
  if (error == http::error::bad_content_length)
    return ending(400, "Content-Length must be one whole number");
  if (error == http::error::bad_transfer_encoding)
    return ending(400, "a body comes with Content-Length, and with it alone");
  return ending(400, concat("the request cannot be read: ", error.message()));
}

/// The refusal of headers that are well formed, but leave open what belongs to the request.
std::optional<HttpReply> ambiguity(const Fields& fields) {
  const auto hosts = fields.count(http::field::host);
  if (hosts > 1 || (hosts == 0 && fields.version() >= 11))
    return ending(400, "a request has one Host");
  const auto lengths = fields.count(http::field::content_length);
  const bool chunks = fields.count(http::field::transfer_encoding) > 0;
  if (lengths > 1 || (lengths == 1 && chunks))
    return ending(400, "a body comes with one Content-Length, and with it alone");
  if (chunks) return ending(411, "say how long the body is: Content-Length");
  return std::nullopt;
}

void read_target(std::string_view target, HttpRequest& request) {
  const std::size_t mark = std::min(target.find('?'), target.size());
  request.path = percent_decoded(target.substr(0, mark));
  std::string_view rest = target.substr(std::min(mark + 1, target.size()));
  while (!rest.empty()) {
    const std::string_view pair = rest.substr(0, rest.find('&'));
    rest.remove_prefix(std::min(pair.size() + 1, rest.size()));
    const std::size_t equals = std::min(pair.find('='), pair.size());
    const std::string_view value = pair.substr(std::min(equals + 1, pair.size()));
    if (pair.empty()) continue;
    const auto added = request.parameters.emplace(percent_decoded(pair.substr(0, equals), true),
                                                  percent_decoded(value, true));
    request.query.insert(*added);
  }
}

std::string_view view(boost::beast::string_view text) {
  return {text.data(), text.size()};
}

std::variant<HttpRequest, HttpReply> request_of(const Fields& fields) {
  if (auto refused = ambiguity(fields)) return *refused;
  HttpRequest request;
  request.method = view(fields.method_string());
  if (!fields.target().starts_with('/')) return ending(400, "the address must begin with a slash");
  read_target(view(fields.target()), request);
  for (const auto& field : fields)
    request.headers.try_emplace(lower_case(view(field.name_string())), view(field.value()));
  request.chunks = fields.version() >= 11;
  request.keep_alive = fields.version() >= 11 && fields.keep_alive();
  const std::string length = request.header("content-length");
  std::uint64_t bytes = 0;
  if (!length.empty()) {
    const char* end = length.data() + length.size();
    const auto [last, fault] = std::from_chars(length.data(), end, bytes);
    if (fault != std::errc() || last != end)  // "5, 5" passes Beast
      return ending(400, "Content-Length must be one whole number");
    request.content_length = bytes;
  }
  if (bytes > 0 && (request.method == "GET" || request.method == "HEAD"))
    return ending(400, concat(request.method, " takes no body"));
  return request;
}

}  // namespace

std::optional<HttpReply> refusal_of_unfinished(std::string_view bytes, const HeadLimits& limits) {
  const bool endless_line = bytes.substr(0, limits.line_bytes).find('\n') == std::string_view::npos;
  if (bytes.size() >= limits.line_bytes && endless_line) return too_long();
  if (bytes.size() >= limits.bytes || count_headers(bytes) > limits.headers)
    return too_large(limits);
  return std::nullopt;
}

std::variant<HttpRequest, HttpReply> parse_head(std::string_view bytes, const HeadLimits& limits) {
  if (bytes.find('\n') >= limits.line_bytes) return too_long();
  if (bytes.size() > limits.bytes || count_headers(bytes) > limits.headers)
    return too_large(limits);
  if (has_stray_bytes(bytes))
    return ending(400, "the head has bytes that belong in none: control characters, folded lines");
  http::request_parser<http::empty_body> parser;
  parser.header_limit(static_cast<std::uint32_t>(limits.bytes));
  parser.body_limit(std::numeric_limits<std::uint64_t>::max());
  boost::system::error_code error;
  parser.put(boost::asio::buffer(bytes), error);
  if (error == http::error::need_more || (!error && !parser.is_header_done()))
    return ending(400, "the request's head has no end");
  if (error) return refusal_of(error);
  return request_of(parser.get());
}

std::string percent_decoded(std::string_view text, bool plus) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned code = 0;
    const char* digits = text.data() + i + 1;
    const bool coded = text[i] == '%' && i + 2 < text.size() &&
                       std::from_chars(digits, digits + 2, code, 16).ptr == digits + 2;
    if (coded) i += 2;
    result += coded ? static_cast<char>(code) : plus && text[i] == '+' ? ' ' : text[i];
  }
  return result;
}

std::string percent_encoded(std::string_view text) {
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  std::string result;
  for (const char letter : text) {
    const auto byte = static_cast<unsigned char>(letter);
    const bool plain = (byte >= '0' && byte <= '9') || (byte >= 'A' && byte <= 'Z') ||
                       (byte >= 'a' && byte <= 'z') ||
                       std::string_view("-._~").find(letter) != std::string_view::npos;
    if (plain)
      result += letter;
    else
      (result += '%').append({kDigits[byte / 16], kDigits[byte % 16]});
  }
  return result;
}

std::string reply_head(const HttpReply& reply, const HttpRequest& request, bool keep_alive) {
  const auto status = static_cast<http::status>(reply.status);
  std::string head = concat("HTTP/1.1 ", reply.status, " ",
                            std::string(view(http::obsolete_reason(status))), "\r\n");
  for (const auto& [name, value] : reply.headers) head += name + ": " + value + "\r\n";
  if (reply.status != 304) head += "Content-Type: " + reply.type + "\r\n";
  if (reply.stream && request.chunks)
    head += "Transfer-Encoding: chunked\r\n";
  else if (!reply.stream && reply.status != 304)
    head += concat("Content-Length: ", reply.body->size(), "\r\n");
  return head + (keep_alive ? "Connection: keep-alive\r\n\r\n" : "Connection: close\r\n\r\n");
}

}  // namespace ovimap
