// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/geometry/camera.h"

namespace ovimap::fixture {

/// For tests that render many frames and look at none of them closely.
inline const PinholeCamera kSmallCamera{64, 48, 48, 48, 31.5f, 23.5f};

}  // namespace ovimap::fixture
