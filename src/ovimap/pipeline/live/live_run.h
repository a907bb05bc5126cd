// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/pipeline/live/frame_intake.h"
#include "ovimap/pipeline/live/live_mapper.h"
#include "ovimap/pipeline/sequence/sequence_run.h"

namespace ovimap {

struct LiveRunResult {
  SequenceResult sequence;
  LiveStatistics statistics;
  double camera_seconds = 0;          ///< from the first frame handed over to the last
  std::int64_t frames_read_late = 0;  ///< decoding was not done when the camera would have been
};

/// Called after every frame is handed over, and now and then while those that wait get their masks
/// after the last one. Returning false ends the former, and the next time the latter; what was
/// fused stays.
using LiveProgress = std::function<bool(std::size_t done, std::size_t total)>;

/// Feeds a recording to the mapper as a camera of `fps` frames a second would, whatever the mapper
/// manages, and drains it. Frames are decoded ahead. Throws Error as run_sequence does, when masks
/// were asked for and none was good, and what a stage threw.
LiveRunResult run_live(const FrameSource& source, const std::vector<std::int64_t>& positions,
                       LiveMapper& mapper, double fps, const LiveProgress& progress = nullptr);

/// Throws Error when these steps of a live run (MapRecord::live_steps) do not tell how to make its
/// map again. `tracked`: poses are found.
void require_repeatable(const std::vector<LiveStep>& steps, bool tracked);

/// Maps a recording as another live run did, by its steps, and makes its map, bit for bit, however
/// long it takes now; drains the mapper, which must be set as that one was. Throws Error when a
/// frame is not there or cannot be read, and as run_live does.
LiveRunResult repeat_live(const FrameSource& source, const std::vector<LiveStep>& steps,
                          LiveMapper& mapper, const LiveProgress& progress = nullptr);

/// What happens to a frame before anything else looks at it; with a fault it is skipped.
using FrameFilter = std::function<FrameRead(Frame)>;

/// Feeds the mapper what comes into `intake` until that ends, waiting for room, and drains it.
/// `progress` is called after every frame and now and then while none comes, with the frames so
/// far; when it returns false the run ends, and the intake with it. What the intake had no room for
/// counts as dropped; what `filter`, which may be null, leaves nothing of is listed as skipped, by
/// its number. Throws as run_live.
LiveRunResult run_pushed(FrameIntake& intake, LiveMapper& mapper,
                         const LiveProgress& progress = nullptr,
                         const FrameFilter& filter = nullptr);

}  // namespace ovimap
