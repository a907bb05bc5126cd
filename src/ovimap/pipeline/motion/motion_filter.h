// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "ovimap/io/map_tables/map_document.h"
#include "ovimap/map/fusion/free_space.h"
#include "ovimap/pipeline/motion/mover_tracker.h"
#include "ovimap/pipeline/motion/moving_pixels.h"
#include "ovimap/segment/mask_fusion.h"

namespace ovimap {

/// Leaves things that move out of what is fused, frame by frame: remembers which space was seen
/// empty, and what stands in it long enough to be part of the place.
class MotionFilter {
 public:
  explicit MotionFilter(const MotionConfig& config) : config_(config), tracker_(config) {}

  /// What moves in the next frame, whose number is `number`; nothing where motion is off or the
  /// deviation of the depth is unknown. `map`: as it was before the frame. `taken_out`: of the
  /// observation's depth, what stands nowhere, whether or not it moves (Frame::taken_out); may be
  /// empty.
  MovingPixels see(const VoxelMap& map, const Observation& observation, const DepthImage& taken_out,
                   const FreeSpaceConfig& free_space, double timestamp_s, std::int64_t number);
  /// Takes back at once what the frame sees through, or something that moves stands in, of surface
  /// that was first seen beside something that moved: it was of that. After `see`, with what it
  /// gave. Returns the slots of the blocks that changed, in block-index order.
  std::vector<std::uint32_t> take_back(VoxelMap& map, const Observation& observation,
                                       const MovingPixels& moving,
                                       const FreeSpaceConfig& free_space);

  /// What moved in one of the last frames, for labels that come late; nullptr: nothing, or it is
  /// too long ago.
  const IdImage* moved_in(std::int64_t number) const;

  /// The poses of all frames were other ones than was thought: nothing was seen empty.
  void forget_space() { space_.clear(), suspects_.clear(); }
  /// Goes on where the mapper of a stored map stopped.
  void restore(SeenFree space, std::vector<Mover> movers, const std::vector<FrameLogEntry>& frames);

  const SeenFree& space() const { return space_; }
  const std::vector<Mover>& movers() const { return tracker_.movers(); }

 private:
  /// Notes the time of a frame; returns for how long the world may have moved since the last one.
  int tick(double timestamp_s);
  bool is_look(const Pose& world_from_camera, double timestamp_s);

  /// Notes how long surface has been seen, and which may be of what moves.
  void stand(const VoxelMap& map, const Observation& observation, const MovingPixels& moving,
             int ticks);

  MotionConfig config_;
  SeenFree space_;
  std::set<std::uint64_t> suspects_;  ///< of its cells, by pack_index
  MoverTracker tracker_;
  std::optional<double> last_s_;
  std::optional<std::pair<Pose, double>> last_look_;
  std::deque<std::pair<std::int64_t, IdImage>> recent_;
};

/// The image with zeros where something moves. `moving` may be empty.
DepthImage still_depth(const DepthImage& depth, const IdImage& moving);

/// The segments without what moves: of one that moves by more than half nothing is left.
Segments still_segments(const Segments& segments, const IdImage& moving);

}  // namespace ovimap
