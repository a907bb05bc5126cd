// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

namespace ovimap {

/// "a, b, c": what `text_of` makes of each item, for a line that people read.
template <class Items, class TextOf = std::identity>
std::string listed(const Items& items, const TextOf& text_of = {}) {
  std::string text;
  for (const auto& item : items) {
    if (!text.empty()) text += ", ";
    text += std::invoke(text_of, item);
  }
  return text;
}

}  // namespace ovimap
