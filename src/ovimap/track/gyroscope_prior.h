// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "ovimap/frames/frame/frame.h"

namespace ovimap {

/// What a gyroscope says of how the camera turned (Frame::orientation), and whether it is to be
/// believed: axes, units or a clock that are not the camera's show in turns that the images
/// contradict again and again.
class GyroscopePrior {
 public:
  /// The rotation last_from_current of the camera since the last tracked frame; nullopt where one
  /// of both has no orientation, or the images contradict the gyroscope.
  std::optional<Eigen::Quaterniond> turn_to(const Frame& frame) const;

  /// A frame was tracked. `turned`: last_from_current as the images tell it, all of it; nullopt
  /// where they do not.
  void tracked(const Frame& frame, const std::optional<Eigen::Matrix3d>& turned);

  /// Turns that were compared, and those of them in which gyroscope and images disagree.
  int compared() const { return compared_; }
  int contradicted() const { return contradicted_; }
  /// It agrees with the images more often than not, after enough turns to say so.
  bool is_confirmed() const { return compared_ >= kFewest && !disagrees(); }
  /// It disagrees likewise. It is listened to on, and may be believed again.
  bool is_contradicted() const { return compared_ >= kFewest && disagrees(); }

 private:
  static constexpr int kFewest = 20;  // turns that must be compared

  bool disagrees() const { return 2 * contradicted_ > compared_; }
  std::optional<Eigen::Quaterniond> last_turn(const Frame& frame) const;

  std::optional<Eigen::Quaterniond> last_;  ///< orientation at the last tracked frame
  int compared_ = 0, contradicted_ = 0;
};

}  // namespace ovimap
