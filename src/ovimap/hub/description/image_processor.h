// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "ovimap/inference/models/model_folder.h"

namespace ovimap {

/// What `file`, a preprocessor_config.json as transformers writes it, does to an image. Throws
/// Error when it does something that ovimap cannot: another filter, a crop of another size than the
/// resize, no square.
ImageInputSpec read_image_processor(const std::filesystem::path& file);

}  // namespace ovimap
