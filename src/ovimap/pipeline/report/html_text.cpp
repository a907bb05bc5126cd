// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/report/html_text.h"

#include <charconv>
#include <cmath>

#include "ovimap/inference/text/unicode.h"

namespace ovimap {

namespace {

constexpr char32_t kReplacement = 0xFFFD;

bool is_allowed(char32_t c) {
  return c == '\t' || c == '\n' || (c >= 0x20 && (c < 0x7F || c > 0x9F));
}

/// RFC 4648, with padding.
void append_base64(std::span<const std::uint8_t> bytes, std::string& out) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) bits = bits << 8 | (k < count ? bytes[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      out += k <= count ? kDigits[bits >> (18 - 6 * k) & 63] : '=';
  }
}

}  // namespace

std::string escape_html(std::string_view text) {
  std::u32string escaped;
  for (const char32_t c : decode_utf8(text)) {
    if (c == '&')
      escaped += U"&amp;";
    else if (c == '<')
      escaped += U"&lt;";
    else if (c == '>')
      escaped += U"&gt;";
    else if (c == '"')
      escaped += U"&quot;";
    else if (c == '\'')
      escaped += U"&#39;";
    else
      escaped += is_allowed(c) ? c : kReplacement;
  }
  return encode_utf8(escaped);
}

std::string picture_uri(std::span<const std::uint8_t> picture) {
  constexpr std::uint8_t kFirstOfPng = 0x89;
  const bool png = !picture.empty() && picture[0] == kFirstOfPng;
  std::string uri = png ? "data:image/png;base64," : "data:image/jpeg;base64,";
  uri.reserve(uri.size() + picture.size() / 3 * 4 + 4);
  append_base64(picture, uri);
  return uri;
}

std::string fixed_number(double value, int decimals) {
  if (!std::isfinite(value)) return "\xe2\x80\x93";  // en dash
  char text[400];  // the largest double has 309 digits before the point
  const auto end =
      std::to_chars(text, text + sizeof(text), value, std::chars_format::fixed, decimals).ptr;
  const std::string number(text, end);
  const bool is_zero = number.find_first_not_of("-0.") == std::string::npos;
  return is_zero && number[0] == '-' ? number.substr(1) : number;
}

std::string grouped_number(std::size_t value) {
  std::string text = std::to_string(value);
  for (std::size_t i = text.size(); i > 3;) text.insert(i -= 3, 1, ',');
  return text;
}

}  // namespace ovimap
