// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "ovimap/frames/frame/frame.h"

namespace ovimap {

/// How far the surface that `frame` sees moves across the picture between the frame's pose and
/// another one: the median over its valid depth, as a share of the picture's width. What the other
/// pose does not see counts as moved by all of it. 0 without valid depth. Unlike metres and
/// degrees it means the same on a desk and in a hall.
/// \param earlier_from_now the motion, in the depth camera's frame
float picture_motion(const Frame& frame, const Pose& earlier_from_now);

/// Says which frames of a walk to ask a network of masks about: those that show something else than
/// the last one that was asked about, and of those one that the camera moved little in, since
/// motion blurs. Looks at poses alone besides the frame at hand, so a resumed run, which has them
/// in its log, goes on as if it had never stopped.
class MaskMotion {
 public:
  /// \param least motion [shares of the picture's width] from one frame with masks to the next; 0:
  /// every frame
  explicit MaskMotion(float least) : least_(least) {}

  /// Whether `frame`, which comes next, should get masks; the first one always.
  bool wants(const Frame& frame) const;
  /// The next frame was taken at this pose.
  void add(const Pose& world_from_camera);
  /// The frame added last got its masks, or is on its way to.
  void masked();
  /// It did not get any after all.
  void went_without() { masked_ = false; }
  /// All frames that were added stood elsewhere than thought.
  void move(std::span<const Pose> world_from_camera);

 private:
  struct Step {
    std::size_t frame = 0;  ///< counted by `add`
    Pose world_from_camera;
  };
  bool slow(const Frame& frame) const;

  float least_;
  std::size_t frames_ = 0;
  bool masked_ = false;     ///< a frame was; else the next one is wanted
  std::vector<Step> walk_;  ///< the last frame with masks and the newest after it
};

}  // namespace ovimap
