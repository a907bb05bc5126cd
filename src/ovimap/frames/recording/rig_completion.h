// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/frames/recording/recording.h"

namespace ovimap {

/// Fills in what the layout left open: image sizes from the first image that can be read, and the
/// one camera from the other when the images are of one size (registered). Throws Error naming what
/// is still missing, with an example of camera.yaml.
void complete_cameras(Recording& recording);

}  // namespace ovimap
