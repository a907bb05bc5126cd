// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace ovimap {

/// Whether a text is one line of UTF-8 that a terminal shows and does not obey: without control
/// characters (C0, DEL, C1), line separators and what turns the direction of writing.
bool is_printable(std::string_view text);
/// The text with U+FFFD for each character, or byte that belongs to none, that is_printable does
/// not accept.
std::string printable(std::string_view text);

}  // namespace ovimap
