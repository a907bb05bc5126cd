// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/frames/frame/wrapped_source.h"
#include "ovimap/geometry/pose.h"

namespace ovimap {

/// A recording in another world frame; in its own until it is moved.
class MovedSource : public WrappedSource {
 public:
  using WrappedSource::WrappedSource;

  /// Not while frames are read.
  void move_to(const Pose& world_from_recording) { world_from_recording_ = world_from_recording; }

  FrameRead read(std::int64_t position) const override {
    FrameRead read = WrappedSource::read(position);
    if (read.frame && read.frame->posed)
      read.frame->world_from_camera = world_from_recording_ * read.frame->world_from_camera;
    return read;
  }

 private:
  Pose world_from_recording_ = Pose::Identity();
};

}  // namespace ovimap
