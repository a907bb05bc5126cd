// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "ovimap/frames/frame/frame_source.h"

namespace ovimap::python {

/// A recording that Python opened.
struct Source {
  std::shared_ptr<const FrameSource> frames;
  std::string path;

  /// What a map says of where its frames came from, as the program writes it.
  std::string text() const { return frames->kind() + ":" + path; }
};

}  // namespace ovimap::python
