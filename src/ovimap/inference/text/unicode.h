// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace ovimap {

/// U+FFFD, which stands where a character cannot be told.
inline constexpr char32_t kReplacementCharacter = 0xFFFD;

/// The characters of `utf8`; each byte that belongs to no valid character becomes U+FFFD.
std::u32string decode_utf8(std::string_view utf8);
std::string encode_utf8(std::u32string_view text);

enum class UnicodeForm {
  kComposed,   ///< NFC
  kDecomposed  ///< NFD
};
std::u32string normalized(std::u32string_view text, UnicodeForm form);

/// Lower case, character by character.
std::u32string lowered(std::u32string_view text);
/// Lower case where a capital sigma at the end of a word becomes a final one, as Python's
/// str.lower does.
std::u32string lowered_in_context(std::u32string_view text);

// Properties of a character; categories are those of the Unicode character database.
bool is_letter(char32_t c);           ///< L*
bool is_number(char32_t c);           ///< N*
bool is_punctuation(char32_t c);      ///< P*, and the symbols of ASCII
bool is_nonspacing_mark(char32_t c);  ///< Mn
bool is_invisible(char32_t c);        ///< Cc, Cf, Co, Cs: control, format, private use
bool is_space(char32_t c);            ///< White_Space
bool is_cjk(char32_t c);              ///< ideographs that BERT's tokenizer takes as a word each

}  // namespace ovimap
