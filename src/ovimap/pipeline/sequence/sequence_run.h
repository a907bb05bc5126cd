// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "ovimap/frames/frame/frame_source.h"
#include "ovimap/io/map_tables/map_document.h"
#include "ovimap/pipeline/mapping/checkpointer.h"
#include "ovimap/pipeline/mapping/mapper.h"
#include "ovimap/pipeline/sequence/pose_finder.h"

namespace ovimap {

struct SkippedFrame {
  std::int64_t position = 0;
  std::string fault;
};

struct SequenceResult {
  std::vector<FrameLogEntry> frames;  ///< those fused, in order
  std::vector<SkippedFrame> skipped;
  PinholeCamera depth_camera;  ///< of the first frame
  double seconds = 0;
};

/// Called after every position: how many of how many are done, and the report of the frame when it
/// was fused. Returning false ends the run early; what was fused stays.
using SequenceProgress =
    std::function<bool(std::size_t done, std::size_t total, const FrameReport* report)>;

/// Feeds the frames at `positions` to the mapper, reading and preparing the next frame while one is
/// mapped, where more than one thread is allowed (allowed_threads). Bad frames are skipped and
/// listed, and so are those whose masks are bad once a frame went well. Throws Error when no frame
/// was usable, naming the commonest fault, and what else the mask source throws. Throws Error as
/// well when every frame has the same pose (unless MapperConfig::allow_still_camera).
/// `begun`: what an earlier run did that this one goes on with. `checkpoints` may be null.
/// `finder`: finds the poses; what it cannot place is skipped. Null: frames have theirs.
SequenceResult run_sequence(const FrameSource& source, const std::vector<std::int64_t>& positions,
                            Mapper& mapper, const SequenceProgress& progress = nullptr,
                            SequenceResult begun = {}, Checkpointer* checkpoints = nullptr,
                            PoseFinder* finder = nullptr);

/// The fault that most skipped frames have, by the first of them.
std::string commonest_fault(const std::vector<SkippedFrame>& skipped);

/// Throws Error when all of several frames have the same pose, unless the config allows it: that
/// means missing tracking far more often than a camera on a tripod.
void require_motion(const std::vector<FrameLogEntry>& frames, const MapperConfig& config);

/// The poses of the depth camera, world_from_camera, in order.
std::vector<Pose> poses_of(const std::vector<FrameLogEntry>& frames);

/// Packs a finished mapper for saving. The mapper must not be used afterwards.
MapDocument make_document(Mapper&& mapper, const SequenceResult& sequence, MapHeader header);

}  // namespace ovimap
