// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/motion/motion_filter.h"

#include <algorithm>
#include <cmath>

#include "ovimap/pipeline/motion/fresh_surface.h"

namespace ovimap {

namespace {

constexpr int kMostTicks = 10;  // a gap in the recording tells nothing of what stood there
constexpr std::size_t kRemembered = 64;

void mark_taken_out(const DepthImage& taken_out, MovingPixels& moving) {
  if (taken_out.empty() || moving.refused) return;
  if (moving.ids.empty()) moving.ids = IdImage(taken_out.width(), taken_out.height());
  for (std::size_t i = 0; i < taken_out.size(); ++i)
    if (taken_out[i] > 0.f && moving.ids[i] == 0) moving.ids[i] = MovingPixels::kTakenOut;
}

}  // namespace

int MotionFilter::tick(double timestamp_s) {
  const double gone = last_s_ ? (timestamp_s - *last_s_) * ticks_of(1.f) : 0;
  last_s_ = timestamp_s;
  // Clocks that stand still or go backwards count as a camera's usual pace.
  if (!(gone >= 1)) return 1;
  return static_cast<int>(std::lround(std::min(gone, double{kMostTicks})));
}

bool MotionFilter::is_look(const Pose& world_from_camera, double timestamp_s) {
  if (last_look_) {
    const Pose moved = last_look_->first.inverse() * world_from_camera;
    const double gone_s = timestamp_s - last_look_->second;
    if (moved.translation().norm() < static_cast<double>(config_.look_step_m) &&
        Eigen::AngleAxisd(moved.linear()).angle() < static_cast<double>(config_.look_turn_rad) &&
        gone_s >= 0 && gone_s < static_cast<double>(config_.look_s))
      return false;
  }
  last_look_.emplace(world_from_camera, timestamp_s);
  return true;
}

MovingPixels MotionFilter::see(const VoxelMap& map, const Observation& observation,
                               const DepthImage& taken_out, const FreeSpaceConfig& free_space,
                               double timestamp_s, std::int64_t number) {
  if (config_.mode == DynamicMode::kOff) return {};
  const int ticks = tick(timestamp_s);
  const bool look = is_look(observation.world_from_camera, timestamp_s);
  if (observation.sigma_m == nullptr || observation.plane_slope == nullptr) return {};
  MovingPixels moving = find_moving(map, space_, observation, config_);
  mark_taken_out(taken_out, moving);
  space_.take(moving.cells, ticks, ticks_of(config_.stays_s));
  stand(map, observation, moving, ticks);
  if (look && !moving.refused) {
    Image<float> made;
    space_.look(observation.camera, observation.world_from_camera,
                free_depth(map.config(), observation, free_space, made),
                map.config().block_size_m());
  }
  if (config_.mode == DynamicMode::kTrack) tracker_.add(moving.patches, timestamp_s, number);
  if (moving.ids.empty()) return moving;
  recent_.emplace_back(number, moving.ids);
  if (recent_.size() > kRemembered) recent_.pop_front();
  return moving;
}

void MotionFilter::stand(const VoxelMap& map, const Observation& observation,
                         const MovingPixels& moving, int ticks) {
  if (moving.refused) return;
  const int known = ticks_of(config_.known_s);
  const StandingCells standing = standing_cells(map, space_, observation, moving.ids, config_);
  space_.stand(standing.known, known, known);
  space_.stand(standing.cells, ticks, known);
  for (const BlockIndex& cell :
       fresh_cells(space_, moving.patches, map.config().block_size_m(), config_)) {
    space_.suspect(cell);
    suspects_.insert(pack_index(cell));
  }
}

std::vector<std::uint32_t> MotionFilter::take_back(VoxelMap& map, const Observation& observation,
                                                   const MovingPixels& moving,
                                                   const FreeSpaceConfig& free_space) {
  if (suspects_.empty() || moving.refused || observation.sigma_m == nullptr) return {};
  std::erase_if(suspects_,
                [this](std::uint64_t key) { return !space_.at(unpack_index(key)).suspect; });
  std::vector<std::uint32_t> blocks;
  for (const std::uint64_t key : suspects_)
    if (const std::uint32_t slot = map.find_slot(unpack_index(key)); slot != kNoBlock)
      blocks.push_back(slot);
  if (blocks.empty()) return {};
  return clear_blocks(map, observation,
                      hasty_free_depth(map.config(), observation, moving.ids, free_space, config_),
                      blocks);
}

const IdImage* MotionFilter::moved_in(std::int64_t number) const {
  const auto found = std::find_if(recent_.begin(), recent_.end(),
                                  [number](const auto& frame) { return frame.first == number; });
  return found == recent_.end() ? nullptr : &found->second;
}

void MotionFilter::restore(SeenFree space, std::vector<Mover> movers,
                           const std::vector<FrameLogEntry>& frames) {
  if (config_.mode == DynamicMode::kOff) return;
  space_ = std::move(space);
  for (const BlockIndex& cell : space_.suspects()) suspects_.insert(pack_index(cell));
  tracker_.restore(std::move(movers), frames);
  for (const FrameLogEntry& frame : frames) {
    tick(frame.timestamp_s);
    is_look(frame.world_from_camera, frame.timestamp_s);
  }
}

DepthImage still_depth(const DepthImage& depth, const IdImage& moving) {
  DepthImage still = depth;
  for (std::size_t i = 0; i < moving.size(); ++i)
    if (moving[i] != 0) still[i] = 0.f;
  return still;
}

Segments still_segments(const Segments& segments, const IdImage& moving) {
  std::vector<int> moves(segments.segments.size() + 1, 0);
  for (std::size_t i = 0; i < moving.size(); ++i) moves[segments.ids[i]] += moving[i] != 0;
  Segments still{segments.ids, {}, segments.ratings};
  std::vector<std::uint16_t> numbers(moves.size(), 0);
  for (std::size_t id = 1; id < moves.size(); ++id) {
    Segment segment = segments.segments[id - 1];
    if (2 * moves[id] > segment.area_px) continue;
    segment.area_px -= moves[id];
    still.segments.push_back(segment);
    numbers[id] = static_cast<std::uint16_t>(still.segments.size());
  }
  for (std::size_t i = 0; i < moving.size(); ++i)
    still.ids[i] = moving[i] != 0 ? std::uint16_t{0} : numbers[still.ids[i]];
  return still;
}

}  // namespace ovimap
