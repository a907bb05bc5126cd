// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/check/check_sample.h"

#include <algorithm>
#include <numbers>

namespace ovimap {

namespace {

class Sampler {
 public:
  Sampler(const FrameSource& source, const SourceCheckConfig& config)
      : source_(source), config_(config), sample_(config.alignment) {}

  /// The frame at `position`, read at its first use; nullptr when it is unusable.
  const ThinFrame* frame(std::int64_t position) {
    const auto [entry, is_new] = sample_.frames.try_emplace(position);
    if (is_new) {
      const FrameRead read = source_.read(position);
      if (read.frame) {
        entry->second = thin_frame(*read.frame, config_.compared_width_px);
        sample_.captures.emplace(position, capture_of(*read.frame));
        sample_.registered &= read.frame->registered();
        if (sample_.frames.size() % 2 == 1) sample_.alignment.add(*read.frame);
      } else {
        sample_.faults[position] = read.fault;
      }
    }
    return entry->second ? &*entry->second : nullptr;
  }

  /// Pairs `position` with the farthest neighbour, up to the gap, towards which the camera turned
  /// little.
  void add_pair(std::int64_t position) {
    const ThinFrame* anchor = frame(position);
    if (anchor == nullptr) return;
    for (std::int64_t gap = config_.pair_gap; gap >= 1; gap /= 2) {
      const std::int64_t other = position + gap < source_.size() ? position + gap : position - gap;
      if (other < 0) continue;
      const ThinFrame* neighbour = frame(other);
      if (neighbour == nullptr || rotation_deg(*anchor, *neighbour) > config_.max_pair_rotation_deg)
        continue;
      sample_.neighbours.emplace_back(*anchor, *neighbour);
      return;
    }
  }

  CheckSample take() { return std::move(sample_); }

 private:
  /// The angle is the same whichever way the poses are meant.
  static double rotation_deg(const ThinFrame& a, const ThinFrame& b) {
    const Eigen::Matrix3d rotation =
        a.world_from_camera.linear().transpose() * b.world_from_camera.linear();
    return Eigen::AngleAxisd(rotation).angle() * 180 / std::numbers::pi;
  }

  const FrameSource& source_;
  const SourceCheckConfig& config_;
  CheckSample sample_;
};

}  // namespace

CheckSample draw_sample(const FrameSource& source, const SourceCheckConfig& config) {
  Sampler sampler(source, config);
  const std::int64_t size = source.size();
  const std::int64_t anchors = std::min<std::int64_t>(size, std::max(1, config.max_frames / 2));
  for (std::int64_t i = 0; i < anchors; ++i) sampler.add_pair(i * size / anchors);
  if (size <= config.max_frames)
    for (std::int64_t i = 0; i < size; ++i) sampler.frame(i);
  return sampler.take();
}

}  // namespace ovimap
