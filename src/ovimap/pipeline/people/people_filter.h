// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <set>

#include "ovimap/frames/frame/frame_source.h"
#include "ovimap/inference/sam/sam_network.h"
#include "ovimap/inference/things/person_finder.h"
#include "ovimap/pipeline/people/person_pixels.h"

namespace ovimap {

/// Takes people out of frames: where they are there is no depth, and the colour is black, so
/// nothing that is made of the frame shows them. Each frame is looked at by itself: the same frame
/// gives the same result. Thread-safe.
class PeopleFilter {
 public:
  /// `outlines` may be null: then depth tells whose a pixel is.
  PeopleFilter(const PeopleConfig& config, std::shared_ptr<const PersonFinder> finder,
               std::shared_ptr<const SamNetwork> outlines = nullptr)
      : config_(config), finder_(std::move(finder)), outlines_(std::move(outlines)) {}

  /// The frame with what was taken out of its depth in Frame::taken_out, or the fault that no depth
  /// is left. Throws Error when a network fails.
  FrameRead without_people(Frame frame) const;

  /// Frames so far that showed somebody, each counted once by its index.
  std::size_t frames_with_people() const;

 private:
  /// `places`: color_places of the frame.
  PeopleMask people_in(const Frame& frame, const Image<std::int32_t>& places,
                       const std::vector<PersonBox>& people) const;
  std::optional<PeopleMask> outline(const ImageFeatures& features, const Frame& frame,
                                    const Eigen::AlignedBox2f& box_px) const;

  const PeopleConfig config_;
  const std::shared_ptr<const PersonFinder> finder_;
  const std::shared_ptr<const SamNetwork> outlines_;
  mutable std::mutex mutex_;
  mutable std::set<std::int64_t> seen_in_;
};

}  // namespace ovimap
