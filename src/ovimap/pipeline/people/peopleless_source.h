// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/frames/frame/wrapped_source.h"
#include "ovimap/pipeline/people/people_filter.h"

namespace ovimap {

/// The frames of a recording without the people in them.
class PeoplelessSource : public WrappedSource {
 public:
  PeoplelessSource(std::unique_ptr<FrameSource> source, std::shared_ptr<const PeopleFilter> filter)
      : WrappedSource(std::move(source)), filter_(std::move(filter)) {}

  FrameRead read(std::int64_t position) const override {
    FrameRead read = WrappedSource::read(position);
    return read.frame ? filter_->without_people(std::move(*read.frame)) : read;
  }

 private:
  std::shared_ptr<const PeopleFilter> filter_;
};

}  // namespace ovimap
