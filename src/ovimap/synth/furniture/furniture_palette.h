// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace ovimap {

/// The class names of everything a room may hold, walls and floor included. The position in the
/// list plus one is the class id in every written scene, so the list only ever grows at its end.
const std::vector<std::string>& room_classes();

/// 1, 2, ... Throws Error with the nearest known name when there is no such class.
std::uint32_t room_class_id(const std::string& class_name);

/// The catalogue ids of the models of a class that were looked at and found sound: upright, of
/// plausible size, textured. Empty for classes made without a model (wall, floor, picture, rug,
/// pillow, blanket).
/// Throws Error as room_class_id does.
const std::vector<std::string>& models_of_class(const std::string& class_name);

}  // namespace ovimap
