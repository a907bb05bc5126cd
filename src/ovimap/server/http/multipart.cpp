// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/http/multipart.h"

#include <algorithm>

#include "ovimap/server/http/request_body.h"

namespace ovimap {

namespace {

constexpr std::size_t kLongestBoundary = 70;  // RFC 2046, section 5.1.1

char lower(char letter) {
  return letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
}

bool same_letters(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](char x, char y) { return lower(x) == lower(y); });
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = std::min(text.find_first_not_of(" \t"), text.size());
  return text.substr(first, text.find_last_not_of(" \t") + 1 - first);
}

/// Takes `text` up to `end`, which goes as well; all of it where there is no `end`.
std::string_view take(std::string_view& text, char end) {
  bool quoted = false;
  std::size_t at = 0;
  for (; at < text.size() && (quoted || text[at] != end); ++at) quoted ^= text[at] == '"';
  const std::string_view taken = text.substr(0, at);
  text.remove_prefix(std::min(at + 1, text.size()));
  return taken;
}

/// Parameter `wanted` of a header's value as `form-data; name="x"`; empty where there is none.
std::string_view parameter(std::string_view value, std::string_view wanted) {
  take(value, ';');
  while (!value.empty()) {
    std::string_view given = take(value, ';');
    if (!same_letters(trimmed(take(given, '=')), wanted)) continue;
    const std::string_view text = trimmed(given);
    const bool quoted = text.size() >= 2 && text.front() == '"' && text.back() == '"';
    return quoted ? text.substr(1, text.size() - 2) : text;
  }
  return {};
}

/// Name of the part that has these headers.
std::string_view name_of_part(std::string_view head) {
  while (!head.empty()) {
    const std::size_t end = std::min(head.find("\r\n"), head.size());
    std::string_view line = head.substr(0, end);
    head.remove_prefix(std::min(end + 2, head.size()));
    if (same_letters(trimmed(take(line, ':')), "content-disposition"))
      return parameter(line, "name");
  }
  return {};
}

[[noreturn]] void refuse(const char* what) {
  throw BadRequest(400, concat("the body is no multipart/form-data: ", what));
}

}  // namespace

std::map<std::string, std::string_view> parse_multipart(std::string_view content_type,
                                                        std::string_view body,
                                                        const MultipartLimits& limits) {
  const std::string_view boundary = parameter(content_type, "boundary");
  if (boundary.empty() || boundary.size() > kLongestBoundary) refuse("it has no sound boundary");
  const std::string border = concat("--", boundary), next_border = concat("\r\n", border);
  if (!body.starts_with(border)) refuse("it does not begin with its boundary");
  body.remove_prefix(border.size());
  std::map<std::string, std::string_view> parts;
  while (!body.starts_with("--")) {
    if (!body.starts_with("\r\n")) refuse("a boundary is followed by other bytes");
    body.remove_prefix(2);
    const std::size_t head = body.substr(0, limits.head_bytes).find("\r\n\r\n");
    if (head == std::string_view::npos) refuse("a part's headers have no end, or are too long");
    const std::string name(name_of_part(body.substr(0, head)));
    body.remove_prefix(head + 4);
    const std::size_t end = body.find(next_border);
    if (end == std::string_view::npos) refuse("a part has no end");
    if (name.empty()) refuse("a part has no name");
    if (!parts.try_emplace(name, body.substr(0, end)).second) refuse("two parts have one name");
    if (parts.size() > limits.parts) refuse("it has too many parts");
    body.remove_prefix(end + next_border.size());
  }
  return parts;
}

}  // namespace ovimap
