// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/track/gyroscope_prior.h"

#include <algorithm>

namespace ovimap {

namespace {

constexpr double kLeastTurn_rad = 0.01;  // smaller ones are lost in the errors of tracking
constexpr double kDisagree = 0.5;        // of the larger of both turns

}  // namespace

std::optional<Eigen::Quaterniond> GyroscopePrior::last_turn(const Frame& frame) const {
  if (!last_ || !frame.orientation) return std::nullopt;
  return last_->conjugate() * *frame.orientation;
}

std::optional<Eigen::Quaterniond> GyroscopePrior::turn_to(const Frame& frame) const {
  return is_contradicted() ? std::nullopt : last_turn(frame);
}

void GyroscopePrior::tracked(const Frame& frame, const std::optional<Eigen::Matrix3d>& turned) {
  const std::optional<Eigen::Quaterniond> turn = last_turn(frame);
  last_ = frame.orientation;
  if (!turn || !turned) return;
  const Eigen::Quaterniond seen(*turned), none = Eigen::Quaterniond::Identity();
  const double larger_rad = std::max(turn->angularDistance(none), seen.angularDistance(none));
  if (larger_rad < kLeastTurn_rad) return;
  ++compared_;
  contradicted_ += turn->angularDistance(seen) > kDisagree * larger_rad;
}

}  // namespace ovimap
