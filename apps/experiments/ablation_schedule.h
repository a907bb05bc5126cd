// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ovimap/frames/frame/frame_source.h"

namespace ovimap::apps {

/// How many frames a second the given frames of a video have, by their timestamps. Throws Error,
/// naming `path`, where they are no video: fewer than three a second, or so far apart for their
/// times that nobody carried the camera; a schedule in seconds means nothing there.
double video_rate(const FrameSource& source, const std::vector<std::int64_t>& positions,
                  const std::string& path);

/// Every how many frames something happens that happens every `period_s`; at least 1.
int frames_between(double period_s, double frames_per_s);

}  // namespace ovimap::apps
