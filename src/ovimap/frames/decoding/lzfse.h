// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace ovimap {

/// Whether the bytes begin like an LZFSE stream.
bool is_lzfse(std::span<const std::uint8_t> bytes);

/// Decompresses an LZFSE stream, as Apple's compression library writes it: blocks bvx2 (entropy
/// coded), bvxn (LZVN) and bvx- (plain), up to the end mark bvx$. Throws Error with a phrase that
/// follows the file's name when the stream is broken or would give more than `max_size` bytes.
std::vector<std::uint8_t> decode_lzfse(std::span<const std::uint8_t> bytes, std::size_t max_size);

}  // namespace ovimap
