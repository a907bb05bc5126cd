// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace ovimap {

/// What is done to a text before it is cut into tokens: what the model saw in training.
enum class TextRule {
  kNone,
  kSiglip,  ///< lower case, ASCII punctuation out, spaces collapsed, U+2581 in front
  kClip,    ///< NFC, spaces collapsed, lower case
  kBert     ///< invisible characters out, ideographs set apart, accents off, lower case
};

/// The text after `rule`, valid UTF-8 whatever the input was.
std::string apply_text_rule(TextRule rule, std::string_view utf8);

}  // namespace ovimap
