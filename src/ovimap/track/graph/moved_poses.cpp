// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/track/graph/moved_poses.h"

#include <algorithm>

#include "ovimap/base/error.h"

namespace ovimap {

std::vector<MovedPose> moved_keyframes(const std::vector<Keyframe>& keyframes,
                                       const std::vector<Pose>& corrected) {
  OVIMAP_ASSERT(keyframes.size() == corrected.size());
  std::vector<MovedPose> moves;
  for (std::size_t i = 0; i < keyframes.size(); ++i)
    moves.push_back(
        {static_cast<double>(keyframes[i].index), keyframes[i].world_from_camera, corrected[i]});
  return moves;
}

Pose pose_between(const Pose& first, const Pose& second, double share) {
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::Quaterniond(first.linear())
                      .slerp(share, Eigen::Quaterniond(second.linear()))
                      .normalized()
                      .matrix();
  pose.translation() = (1 - share) * first.translation() + share * second.translation();
  return pose;
}

std::vector<Pose> follow(const std::vector<Pose>& poses, const std::vector<double>& at,
                         const std::vector<MovedPose>& moves) {
  OVIMAP_ASSERT(poses.size() == at.size() && !moves.empty());
  std::vector<Pose> result;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const auto next = std::upper_bound(moves.begin(), moves.end(), at[i],
                                       [](double time, const MovedPose& m) { return time < m.at; });
    const MovedPose& after = next == moves.end() ? moves.back() : *next;
    const MovedPose& before = next == moves.begin() ? moves.front() : *std::prev(next);
    const double gap = after.at - before.at;
    const double share = gap > 0 ? std::clamp((at[i] - before.at) / gap, 0., 1.) : 0;
    const auto moved = [&](const MovedPose& move) {
      return Pose(move.after * move.before.inverse() * poses[i]);
    };
    result.push_back(pose_between(moved(before), moved(after), share));
  }
  return result;
}

}  // namespace ovimap
