// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "ovimap/image/codec.h"

namespace ovimap {

/// Of a PNG or JPEG, from its head alone. Throws as decode_rgb does.
ImageSize image_size(std::span<const std::uint8_t> bytes);

}  // namespace ovimap
