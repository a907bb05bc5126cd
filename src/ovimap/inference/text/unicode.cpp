// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/text/unicode.h"

#include <utf8proc.h>

#include <algorithm>
#include <array>

#include <new>
#include <vector>

namespace ovimap {

namespace {

constexpr char32_t kCapitalSigma = 0x3A3, kFinalSigma = 0x3C2;
constexpr char32_t kCapitalDottedI = 0x130, kDotAbove = 0x307;

utf8proc_category_t category(char32_t c) {
  return utf8proc_category(static_cast<utf8proc_int32_t>(c));
}

bool is_between(utf8proc_category_t value, utf8proc_category_t low, utf8proc_category_t high) {
  return value >= low && value <= high;
}

char32_t lower(char32_t c) {
  return static_cast<char32_t>(utf8proc_tolower(static_cast<utf8proc_int32_t>(c)));
}

void append_lower(char32_t c, std::u32string& out) {
  // The only character whose lower case is two.
  if (c == kCapitalDottedI)
    out += {U'i', kDotAbove};
  else
    out += lower(c);
}

bool is_cased(char32_t c) {
  return is_between(category(c), UTF8PROC_CATEGORY_LU, UTF8PROC_CATEGORY_LT) || c == 0xAA ||
         c == 0xBA || lower(c) != c ||
         utf8proc_toupper(static_cast<utf8proc_int32_t>(c)) != static_cast<utf8proc_int32_t>(c);
}

/// Case_Ignorable: what may stand between the letters of a word without ending it.
bool is_ignored_for_case(char32_t c) {
  static constexpr std::array<char32_t, 17> kMidWord = {
      0x27,   0x2E,   0x3A,   0xB7,   0x387,  0x55F,  0x5F4,  0x2018, 0x2019,
      0x2024, 0x2027, 0xFE13, 0xFE52, 0xFE55, 0xFF07, 0xFF0E, 0xFF1A};
  switch (category(c)) {
    case UTF8PROC_CATEGORY_MN:
    case UTF8PROC_CATEGORY_ME:
    case UTF8PROC_CATEGORY_CF:
    case UTF8PROC_CATEGORY_LM:
    case UTF8PROC_CATEGORY_SK:
      return true;
    default:
      return std::binary_search(kMidWord.begin(), kMidWord.end(), c);
  }
}

bool ends_a_word(std::u32string_view text, std::size_t at) {
  std::size_t before = at;
  while (before > 0 && is_ignored_for_case(text[before - 1])) --before;
  if (before == 0 || !is_cased(text[before - 1])) return false;
  std::size_t after = at + 1;
  while (after < text.size() && is_ignored_for_case(text[after])) ++after;
  return after == text.size() || !is_cased(text[after]);
}

}  // namespace

std::u32string decode_utf8(std::string_view utf8) {
  std::u32string text;
  text.reserve(utf8.size());
  const auto* bytes = reinterpret_cast<const utf8proc_uint8_t*>(utf8.data());
  for (std::size_t at = 0; at < utf8.size();) {
    utf8proc_int32_t c = 0;
    const utf8proc_ssize_t used =
        utf8proc_iterate(bytes + at, static_cast<utf8proc_ssize_t>(utf8.size() - at), &c);
    text += used > 0 ? static_cast<char32_t>(c) : kReplacementCharacter;
    at += used > 0 ? static_cast<std::size_t>(used) : 1;
  }
  return text;
}

std::string encode_utf8(std::u32string_view text) {
  std::string utf8;
  utf8.reserve(text.size());
  for (const char32_t c : text) {
    std::array<utf8proc_uint8_t, 4> bytes{};
    const auto used = utf8proc_encode_char(static_cast<utf8proc_int32_t>(c), bytes.data());
    utf8.append(reinterpret_cast<const char*>(bytes.data()), static_cast<std::size_t>(used));
  }
  return utf8;
}

std::u32string normalized(std::u32string_view text, UnicodeForm form) {
  const std::string utf8 = encode_utf8(text);
  const auto wanted = form == UnicodeForm::kComposed ? UTF8PROC_COMPOSE : UTF8PROC_DECOMPOSE;
  const auto options = static_cast<utf8proc_option_t>(UTF8PROC_STABLE | wanted);
  const auto* bytes = reinterpret_cast<const utf8proc_uint8_t*>(utf8.data());
  const auto size = static_cast<utf8proc_ssize_t>(utf8.size());
  const utf8proc_ssize_t count = utf8proc_decompose(bytes, size, nullptr, 0, options);
  if (count < 0) throw std::bad_alloc();  // the only fault there can be with valid UTF-8
  std::vector<utf8proc_int32_t> buffer(static_cast<std::size_t>(count) + 1);
  utf8proc_decompose(bytes, size, buffer.data(), count, options);
  const utf8proc_ssize_t left = utf8proc_normalize_utf32(buffer.data(), count, options);
  return {buffer.begin(), buffer.begin() + left};
}

std::u32string lowered(std::u32string_view text) {
  std::u32string out;
  out.reserve(text.size());
  for (const char32_t c : text) append_lower(c, out);
  return out;
}

std::u32string lowered_in_context(std::u32string_view text) {
  std::u32string out;
  out.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i)
    if (text[i] == kCapitalSigma && ends_a_word(text, i))
      out += kFinalSigma;
    else
      append_lower(text[i], out);
  return out;
}

bool is_letter(char32_t c) {
  return is_between(category(c), UTF8PROC_CATEGORY_LU, UTF8PROC_CATEGORY_LO);
}

bool is_number(char32_t c) {
  return is_between(category(c), UTF8PROC_CATEGORY_ND, UTF8PROC_CATEGORY_NO);
}

bool is_punctuation(char32_t c) {
  if (c < 0x80) return c > U' ' && c < 0x7F && !is_letter(c) && !is_number(c);
  return is_between(category(c), UTF8PROC_CATEGORY_PC, UTF8PROC_CATEGORY_PO);
}

bool is_nonspacing_mark(char32_t c) {
  return category(c) == UTF8PROC_CATEGORY_MN;
}

bool is_invisible(char32_t c) {
  return is_between(category(c), UTF8PROC_CATEGORY_CC, UTF8PROC_CATEGORY_CO);
}

bool is_space(char32_t c) {
  return (c >= 0x9 && c <= 0xD) || c == 0x85 ||
         is_between(category(c), UTF8PROC_CATEGORY_ZS, UTF8PROC_CATEGORY_ZP);
}

bool is_cjk(char32_t c) {
  static constexpr std::array<std::array<char32_t, 2>, 7> kRanges = {{{0x3400, 0x4DBF},
                                                                      {0x4E00, 0x9FFF},
                                                                      {0xF900, 0xFAFF},
                                                                      {0x20000, 0x2A6DF},
                                                                      {0x2A700, 0x2B81F},
                                                                      {0x2B920, 0x2CEAF},
                                                                      {0x2F800, 0x2FA1F}}};
  return std::any_of(kRanges.begin(), kRanges.end(),
                     [c](const auto& range) { return c >= range[0] && c <= range[1]; });
}

}  // namespace ovimap
