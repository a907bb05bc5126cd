// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <utility>

#include "ovimap/frames/frame/frame_source.h"
#include "ovimap/geometry/pose.h"

namespace ovimap {

/// A recording in another world frame.
class MovedSource : public FrameSource {
 public:
  MovedSource(std::unique_ptr<FrameSource> source, const Pose& world_from_recording)
      : source_(std::move(source)), world_from_recording_(world_from_recording) {}

  std::string kind() const override { return source_->kind(); }
  std::int64_t size() const override { return source_->size(); }
  bool posed() const override { return source_->posed(); }
  bool rectified() const override { return source_->rectified(); }
  FrameRead read(std::int64_t position) const override {
    FrameRead read = source_->read(position);
    if (read.frame && read.frame->posed)
      read.frame->world_from_camera = world_from_recording_ * read.frame->world_from_camera;
    return read;
  }
  std::optional<IdImage> truth_ids(std::int64_t position) const override {
    return source_->truth_ids(position);
  }

 private:
  std::unique_ptr<FrameSource> source_;
  Pose world_from_recording_;
};

}  // namespace ovimap
