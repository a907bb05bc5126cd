// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "ovimap/synth/rooms/room.h"
#include "ovimap/synth/rooms/room_spec.h"

namespace ovimap {

/// Floor, four walls with skirting boards, ceiling; ids are not set yet.
std::vector<RoomObject> room_shell(const RoomSpec& spec);

/// Flat things made without a model, in their own frame like a furniture model (front -y, base at z
/// = 0).
TexturedMesh picture_model(const Eigen::Vector3f& size_m, std::uint64_t seed);
TexturedMesh rug_model(const Eigen::Vector3f& size_m, std::uint64_t seed);
/// The view behind a window's panes, shining.
TexturedMesh outdoor_model(const Eigen::Vector3f& size_m, std::uint64_t seed);

}  // namespace ovimap
