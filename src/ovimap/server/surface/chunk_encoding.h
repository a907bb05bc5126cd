// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "ovimap/server/surface/mesh_chunks.h"

namespace ovimap {

/// A chunk as the viewer reads it; docs/http-api.md describes the bytes. Only patches newer than
/// `since` are in it (0: all), among them empty ones, whose block lost its surface.
///
/// `errors`: how well the surface is known, where patches do not tell it.
std::string encode_chunk(const MeshChunk& chunk, const ChunkGrid& grid, int level,
                         std::uint64_t since = 0, const BlockErrors& errors = {});

}  // namespace ovimap
