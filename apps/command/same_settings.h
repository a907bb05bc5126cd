// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "command.h"

namespace ovimap::apps {

/// Throws Error where a run is resumed with another recording than its last one: two places would
/// lie in one map.
void require_same_source(const MapDocument& begun, const std::string& source);

/// Throws Error naming the first setting in which two runs differ, of those that decide what the
/// map becomes. `option`: the one by which this one goes on with the other.
void require_same_settings(const std::string& begun, const std::string& now, const char* option);

/// Throws Error unless `encoder` (null: none) embeds in the space of the map's embeddings.
void require_same_encoder(const EncoderIdentity& begun,
                          const std::shared_ptr<ImageTextEncoder>& encoder);

/// Throws Error unless a visit has the voxels of the map that it goes on with, and embeds in the
/// space of its embeddings; a map that has none may get some.
void require_same_map(const MapDocument& begun, const VoxelMapConfig& map,
                      const std::shared_ptr<ImageTextEncoder>& encoder);

}  // namespace ovimap::apps
