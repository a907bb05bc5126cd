// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "ovimap/image/image.h"

namespace ovimap {

/// Depth as OpenNI's recorders compress it ("16zP"): the first value, then nibbles of differences.
/// `with_table` ("16zT"): the numbers are places in a table of values, which comes first. Throws
/// Error with a phrase that follows the file's name ("is broken OpenNI depth") when the bytes are
/// no such image of that size.
Image<std::uint16_t> decode_oni_depth(std::span<const std::uint8_t> bytes, int width, int height,
                                      bool with_table);

}  // namespace ovimap
