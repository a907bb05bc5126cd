// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace ovimap {

/// Orders names as people do: runs of digits count as numbers, so "2.jpg" comes before "10.jpg".
bool natural_less(std::string_view a, std::string_view b);

}  // namespace ovimap
