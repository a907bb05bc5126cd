// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace ovimap {

/// Which of "zstd" and "gzip" a client accepts, the better one first; empty: neither.
std::string choose_encoding(const std::string& accept_encoding);

/// `body` in that encoding. Throws DefectError for another one.
std::string compressed(const std::string& body, const std::string& encoding);

}  // namespace ovimap
