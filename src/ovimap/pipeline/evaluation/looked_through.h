// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "ovimap/frames/frame/frame_source.h"

namespace ovimap {

using Points = std::vector<Eigen::Vector3f>;

/// In how many of a recording's frames each point is looked through, or is at least in sight: what
/// is seen there lies no nearer than `behind_m` behind the point. World frame, metres; the points
/// must outlive it.
class LookedThrough {
 public:
  LookedThrough(const Points& points, float behind_m)
      : points_(points), counts_(points.size(), 0), behind_m_(behind_m) {}

  /// Frames that cannot be read count for nothing.
  void add(const FrameSource& source);
  /// How many points so many frames looked through.
  std::size_t count(int frames) const { return count(frames, 0, counts_.size()); }
  /// Of some of the points.
  std::size_t count(int frames, std::size_t first, std::size_t points) const;
  Points at_least(int frames) const;

 private:
  void add(const Frame& frame);

  const Points& points_;
  std::vector<int> counts_;
  float behind_m_;
};

}  // namespace ovimap
