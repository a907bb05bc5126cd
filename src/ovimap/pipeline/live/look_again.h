// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

namespace ovimap {

/// How long a thread of a live run waits before it looks whether to go on.
constexpr std::chrono::milliseconds kLook{50};

}  // namespace ovimap
