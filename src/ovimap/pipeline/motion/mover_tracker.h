// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ovimap/io/map_tables/map_document.h"
#include "ovimap/pipeline/motion/moving_pixels.h"

namespace ovimap {

/// Follows things that move from frame to frame. Patches near each other are one thing; it is that
/// which was nearest to where it should be by now, if its own speed carried it on. What is not seen
/// for a while, or stands still until it is part of the place, ends.
class MoverTracker {
 public:
  explicit MoverTracker(const MotionConfig& config) : config_(config) {}

  void add(std::span<const MovingPatch> patches, double timestamp_s, std::int64_t number);
  void restore(std::vector<Mover> movers, const std::vector<FrameLogEntry>& frames);
  /// All so far, in the order of their ids.
  const std::vector<Mover>& movers() const { return movers_; }

 private:
  struct Live {
    std::size_t mover;  ///< in movers_
    double last_s;
    Eigen::Vector3f velocity_mps;
  };
  void follow(Live& live, const MovingPatch& thing, double timestamp_s, std::int64_t number);
  void begin(const MovingPatch& thing, double timestamp_s, std::int64_t number);
  std::vector<MovingPatch> things_of(std::span<const MovingPatch> patches) const;

  MotionConfig config_;
  std::vector<Mover> movers_;
  std::vector<Live> live_;  ///< those that may be seen again
};

}  // namespace ovimap
