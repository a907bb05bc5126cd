// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace ovimap {

struct MultipartLimits {
  std::size_t parts = 8;
  std::size_t head_bytes = 1 << 10;  ///< of one part's headers
};

/// The parts of a multipart/form-data body by their names, as views of `body` (RFC 7578). The cost
/// grows with the body's bytes alone. Throws BadRequest where the body is none, for a name that
/// comes twice and beyond the limits.
std::map<std::string, std::string_view> parse_multipart(std::string_view content_type,
                                                        std::string_view body,
                                                        const MultipartLimits& limits = {});

}  // namespace ovimap
