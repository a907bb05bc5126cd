// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "ovimap/io/corrections/map_edit_log.h"

namespace ovimap {

struct MapDocument;

/// Appends an edit to the map's log, in place and in one transaction: a crash leaves the map with
/// or without it, never between. What mapping found stays in the file; everything that reads the
/// map sees it corrected. Returns the edit as it is stored. Throws Error when it makes no sense in
/// this map, when the map is locked against it, cannot be written, or is being changed by somebody
/// else; the map is then as before.
MapEdit edit_map(const std::filesystem::path& path, MapEdit edit);

/// The map's log, oldest first.
MapEdits read_edits(const std::filesystem::path& path);

/// Saves `document`, which was made of the map at `path`, in its place: what people corrected there
/// since it was read is corrected in it as well, under ids that are free in it, and nobody corrects
/// the map while it is replaced. Returns what makes no sense any more, a line for each such edit.
/// Throws what reading and saving a map throws.
std::vector<std::string> replace_map(const std::filesystem::path& path, MapDocument& document);

/// The map as people corrected it, for everybody who shows or exports it. It must not be saved:
/// that would take the corrections for findings. Its voxels are read when they are asked for
/// (load_map_by_tiles). load_map gives what mapping found, with the log.
MapDocument load_corrected_map(const std::filesystem::path& path);

}  // namespace ovimap
