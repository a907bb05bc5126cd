// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "ovimap/frames/frame/frame_source.h"

namespace ovimap {

/// A recording that is another one but for what derived classes change.
class WrappedSource : public FrameSource {
 public:
  explicit WrappedSource(std::unique_ptr<FrameSource> source) : source_(std::move(source)) {}

  std::string kind() const override { return source_->kind(); }
  std::int64_t size() const override { return source_->size(); }
  bool posed() const override { return source_->posed(); }
  bool rectified() const override { return source_->rectified(); }
  FrameRead read(std::int64_t position) const override { return source_->read(position); }
  std::optional<IdImage> truth_ids(std::int64_t position) const override {
    return source_->truth_ids(position);
  }

 private:
  std::unique_ptr<FrameSource> source_;
};

}  // namespace ovimap
