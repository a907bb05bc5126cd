// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "ovimap/inference/encoders/image_text_encoder.h"
#include "ovimap/instance/instance_registry.h"

namespace ovimap {

/// A thing that a person named in some map.
struct TaughtThing {
  std::string name;
  std::string map;        ///< absolute path of its file
  InstanceId object = 0;  ///< there
  EncoderIdentity encoder;
  Eigen::VectorXf look;  ///< [encoder.dimension] by that encoder, length 1
};

/// What people taught, as docs/query.md describes the file: about 3 KB a thing. Numbers of looks
/// are kept in 8 bits, which moves cosines by less than 0.001. A file that is not there holds
/// nothing. Throws Error for one that is none or cannot be read.
std::vector<TaughtThing> read_taught_file(const std::filesystem::path& file);

/// Replaces what the file holds of that map by `things`, and leaves the others. One step: whoever
/// reads meanwhile sees the old things or the new ones, and programs that teach at the same time
/// wait for each other. Folders are made. Throws Error where it cannot be written, and then nothing
/// changed.
void replace_taught_things(const std::filesystem::path& file, const std::string& map,
                           const std::vector<TaughtThing>& things);

}  // namespace ovimap
