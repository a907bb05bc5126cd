// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "ovimap/frames/frame/frame_source.h"
#include "ovimap/io/map_tables/map_document.h"
#include "ovimap/io/pictures/pictures.h"

namespace ovimap {

/// The map from above.
struct TopDownPictures {
  RgbImage instances;  ///< objects in their palette colours
  RgbImage colors;     ///< the surface in its own
};
TopDownPictures top_down_pictures(const MapDocument& document);

/// Frames of the recording, evenly spread over those in the map, each beside the map's instances as
/// its camera sees them.
RgbImage contact_sheet_picture(const MapDocument& document, const FrameSource& source, int frames);

/// Creates `folder` and those above it. Throws Error when that cannot be.
void make_folder(const std::filesystem::path& folder);

/// Writes top_view.png, top_view_color.png and contact_sheet.png into `folder`, which is created.
void write_map_pictures(const std::filesystem::path& folder, const MapDocument& document,
                        const FrameSource& source);

}  // namespace ovimap
