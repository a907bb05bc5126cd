// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/check/pose_offset.h"

#include <map>
#include <optional>

#include "ovimap/base/parallel.h"
#include "ovimap/frames/check/depth_agreement.h"

namespace ovimap {

namespace {

using Neighbours = std::vector<std::pair<ThinFrame, ThinFrame>>;

constexpr std::int64_t kOffsets[] = {-20, -15, -10, -7, -5, -4, -3, -2, -1,
                                     1,   2,   3,   4,  5,  7,  10, 15, 20};
constexpr std::size_t kMostPairs = 12;  // reading takes the time, and so many tell

struct StoredPose {
  Pose world_from_camera;
  double timestamp_s = 0;
};
/// By position; frames that cannot be used have none.
using StoredPoses = std::map<std::int64_t, std::optional<StoredPose>>;

StoredPoses read_poses(const FrameSource& source, const Neighbours& neighbours) {
  StoredPoses poses;
  for (const auto& pair : neighbours)
    for (const ThinFrame* frame : {&pair.first, &pair.second}) {
      poses[frame->position];
      for (const std::int64_t offset : kOffsets)
        if (const std::int64_t p = frame->position + offset; p >= 0 && p < source.size()) poses[p];
    }
  std::vector<StoredPoses::value_type*> entries;
  for (auto& entry : poses) entries.push_back(&entry);
  parallel_for(entries.size(), 1, [&](std::size_t i) {
    if (const FrameRead read = source.read(entries[i]->first); read.frame)
      entries[i]->second = {read.frame->world_from_camera, read.frame->timestamp_s};
  });
  return poses;
}

const StoredPose* find(const StoredPoses& poses, std::int64_t position) {
  const auto entry = poses.find(position);
  return entry != poses.end() && entry->second ? &*entry->second : nullptr;
}

PoseOffset try_offset(const Neighbours& neighbours, const StoredPoses& poses, std::int64_t offset,
                      const SourceCheckConfig& config) {
  Neighbours shifted;
  double seconds = 0;
  for (const auto& [a, b] : neighbours) {
    const StoredPose *own = find(poses, a.position), *pose_a = find(poses, a.position + offset),
                     *pose_b = find(poses, b.position + offset);
    if (!own || !pose_a || !pose_b) continue;
    shifted.emplace_back(a, b);
    shifted.back().first.world_from_camera = pose_a->world_from_camera;
    shifted.back().second.world_from_camera = pose_b->world_from_camera;
    seconds += pose_a->timestamp_s - own->timestamp_s;
  }
  if (shifted.size() * 2 < neighbours.size()) return {};
  const Agreement agreement = measure_agreement(shifted, {}, config.depth_tolerance);
  if (agreement.overlap() < config.min_overlap) return {};
  return {offset, seconds / static_cast<double>(shifted.size()), agreement.share()};
}

}  // namespace

PoseOffset find_pose_offset(const FrameSource& source, const Neighbours& neighbours,
                            const SourceCheckConfig& config) {
  Neighbours some;
  const std::size_t every = neighbours.size() / kMostPairs + 1;
  for (std::size_t i = 0; i < neighbours.size(); i += every) some.push_back(neighbours[i]);
  const StoredPoses poses = read_poses(source, some);
  PoseOffset best;
  for (const std::int64_t offset : kOffsets) {
    const PoseOffset tried = try_offset(some, poses, offset, config);
    if (tried.agreement > best.agreement) best = tried;
  }
  return best;
}

}  // namespace ovimap
