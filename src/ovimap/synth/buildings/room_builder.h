// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "ovimap/synth/furniture/furniture_catalog.h"
#include "ovimap/synth/rooms/room.h"
#include "ovimap/synth/rooms/room_layout.h"
#include "ovimap/synth/rooms/room_spec.h"

namespace ovimap {

/// The space of a doorway from the wall's face `depth_m` into the room; negative: into the wall.
OrientedBox doorway_box(const RoomSpec& spec, const Doorway& doorway, float depth_m);

/// Makes the room of a spec: the same spec gives the same room on every machine. Several layouts
/// are drawn from the seed and the one that holds the most pieces is taken; pieces without a place
/// are left out. Throws Error when furniture is asked for and its package is missing, or a class or
/// model is unknown.
SynthRoom build_room(const RoomSpec& spec,
                     const std::filesystem::path& furniture_folder = default_furniture_folder(),
                     const LayoutConfig& config = {});

}  // namespace ovimap
