// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>

namespace ovimap {

inline constexpr float kPi = std::numbers::pi_v<float>;
inline constexpr float kTurn_rad = 2 * kPi;  ///< all the way round

}  // namespace ovimap
