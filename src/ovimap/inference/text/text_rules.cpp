// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/text/text_rules.h"

#include <algorithm>

#include "ovimap/inference/text/unicode.h"

namespace ovimap {

namespace {

constexpr char32_t kSpaceSymbol = 0x2581;  // how SentencePiece writes a space

/// Each run of what `is_blank` accepts becomes one space.
template <class IsBlank>
std::u32string collapsed(std::u32string_view text, IsBlank is_blank) {
  std::u32string out;
  out.reserve(text.size());
  for (const char32_t c : text)
    if (!is_blank(c))
      out += c;
    else if (out.empty() || out.back() != U' ')
      out += U' ';
  return out;
}

/// Python's str.isspace, which also takes the four ASCII separators.
bool is_python_space(char32_t c) {
  return is_space(c) || (c >= 0x1C && c <= 0x1F);
}

std::u32string siglip_rule(std::u32string text) {
  std::replace(text.begin(), text.end(), kSpaceSymbol, U' ');
  text = lowered_in_context(text.insert(0, 1, kSpaceSymbol));
  std::erase_if(text, [](char32_t c) { return c < 0x80 && is_punctuation(c); });
  text = collapsed(text, is_python_space);
  if (text.back() == U' ') text.pop_back();
  return text;
}

std::u32string clip_rule(std::u32string_view text) {
  return lowered(collapsed(normalized(text, UnicodeForm::kComposed), is_space));
}

std::u32string bert_rule(std::u32string_view text) {
  std::u32string clean;
  clean.reserve(text.size());
  for (const char32_t c : text) {
    if (c == U'\t' || c == U'\n' || c == U'\r')
      clean += U' ';
    else if (is_invisible(c) || c == kReplacementCharacter)
      continue;
    else if (is_space(c))
      clean += U' ';
    else if (is_cjk(c))
      clean += {U' ', c, U' '};
    else
      clean += c;
  }
  clean = normalized(clean, UnicodeForm::kDecomposed);
  std::erase_if(clean, is_nonspacing_mark);
  return lowered(clean);
}

}  // namespace

std::string apply_text_rule(TextRule rule, std::string_view utf8) {
  std::u32string text = decode_utf8(utf8);
  switch (rule) {
    case TextRule::kNone:
      break;
    case TextRule::kSiglip:
      text = siglip_rule(std::move(text));
      break;
    case TextRule::kClip:
      text = clip_rule(text);
      break;
    case TextRule::kBert:
      text = bert_rule(text);
      break;
  }
  return encode_utf8(text);
}

}  // namespace ovimap
