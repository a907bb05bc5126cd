// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/frames/frame/frame_source.h"
#include "ovimap/pipeline/people/people_filter.h"

namespace ovimap {

/// The frames of a recording without the people in them.
class PeoplelessSource : public FrameSource {
 public:
  PeoplelessSource(std::unique_ptr<FrameSource> source, std::shared_ptr<const PeopleFilter> filter)
      : source_(std::move(source)), filter_(std::move(filter)) {}

  std::string kind() const override { return source_->kind(); }
  std::int64_t size() const override { return source_->size(); }
  bool posed() const override { return source_->posed(); }
  bool rectified() const override { return source_->rectified(); }
  FrameRead read(std::int64_t position) const override {
    FrameRead read = source_->read(position);
    return read.frame ? filter_->without_people(std::move(*read.frame)) : read;
  }
  std::optional<IdImage> truth_ids(std::int64_t position) const override {
    return source_->truth_ids(position);
  }

 private:
  std::unique_ptr<FrameSource> source_;
  std::shared_ptr<const PeopleFilter> filter_;
};

}  // namespace ovimap
