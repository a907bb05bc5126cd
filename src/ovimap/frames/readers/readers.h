// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "ovimap/frames/recording/recording.h"

namespace ovimap {

/// One data set layout: how to tell it, and how to list its frames. One small file implements each.
struct Reader {
  const char* kind;
  const char* looks_for;  ///< for the message when nothing fits
  /// Both take SOURCE: a folder or, for a layout of one file, that file.
  bool (*recognises)(const std::filesystem::path& source);
  /// Throws Error when the layout's own description is broken.
  Recording (*list_frames)(const std::filesystem::path& source, const FrameSourceConfig& config);
};

extern const Reader kReplicaReader;
extern const Reader kSevenScenesReader;
extern const Reader kTumReader;
extern const Reader kIclNuimReader;
extern const Reader kScanNetReader;
extern const Reader kSensReader;
extern const Reader kOniReader;
extern const Reader kRedwoodReader;
extern const Reader kRecord3dReader;
extern const Reader kFolderReader;

}  // namespace ovimap
