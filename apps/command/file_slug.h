// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cctype>
#include <cstddef>
#include <string>

namespace ovimap::apps {

/// A text as a part of a file name, at most so long: letters, digits and single dashes. "mug on the
/// table" becomes "mug-on-the-table".
inline std::string file_slug(const std::string& text, std::size_t longest = std::string::npos) {
  std::string result;
  for (const char letter : text) {
    const bool plain = std::isalnum(static_cast<unsigned char>(letter)) != 0;
    if (plain || (!result.empty() && result.back() != '-')) result += plain ? letter : '-';
    if (result.size() == longest) break;
  }
  while (!result.empty() && result.back() == '-') result.pop_back();
  return result;
}

}  // namespace ovimap::apps
