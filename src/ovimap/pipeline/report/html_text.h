// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace ovimap {

/// `text` as a browser shows it, letter by letter, in elements and in quoted attributes. What is
/// not UTF-8 and what HTML does not allow (control characters) becomes U+FFFD.
std::string escape_html(std::string_view text);

/// "data:image/jpeg;base64,...": a picture inside the page. PNG or JPEG, told by its first byte.
std::string picture_uri(std::span<const std::uint8_t> picture);

/// Like "1.20", whatever the locale; a dash when not finite.
std::string fixed_number(double value, int decimals);

/// Like "12,345".
std::string grouped_number(std::size_t value);

}  // namespace ovimap
