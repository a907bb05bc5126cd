// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace ovimap {

/// The most that a focal length is, and a principal point on either side: what a map keeps, so that
/// what was mapped can be saved.
constexpr float kMostFocal_px = 1e9f;

}  // namespace ovimap
