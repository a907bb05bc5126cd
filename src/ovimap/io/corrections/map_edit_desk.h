// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/io/corrections/map_corrections.h"

namespace ovimap {

/// Judges an edit against a map as it is corrected so far, completes it and appends it to the log
/// of `found`: what edit_map does to a file, for a map that is still being made. Throws Error when
/// the edit makes no sense; the log is then as before.
MapEdit append_edit(MapRecord& found, const LabelForest& forest, const VoxelSource& voxels,
                    MapEdit edit);

}  // namespace ovimap
