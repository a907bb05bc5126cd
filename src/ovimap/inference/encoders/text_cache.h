// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>

#include "ovimap/inference/encoders/image_text_encoder.h"

namespace ovimap {

/// A thousand queries of seven prompts and 768 numbers each, or some ten thousand of one prompt.
inline constexpr std::size_t kRecentTextBytes = 24 << 20;

/// The encoder, with texts encoded once. The latest lists of texts are kept in memory,
/// kRecentTextBytes at most, so that what is asked again and again costs no encoding. Vocabularies
/// are kept in files of `folder` as well, one for each list and model, for the next program; what a
/// person asks is never stored. A file that cannot be read, is damaged or cannot be written is done
/// without; processes may share the folder. Empty `folder`: memory alone.
std::unique_ptr<ImageTextEncoder> remember_text_lists(std::unique_ptr<ImageTextEncoder> encoder,
                                                      std::filesystem::path folder);

/// Where programs of this user keep such files: $XDG_CACHE_HOME/ovimap, else ~/.cache/ovimap; empty
/// where neither is known.
std::filesystem::path user_cache_folder();

}  // namespace ovimap
