// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace ovimap {

/// How many vertices an instance has.
struct InstanceSize {
  std::int64_t id = 0;
  std::int64_t vertices = 0;
};

/// A truth and a predicted instance that share vertices.
struct InstanceOverlap {
  std::size_t truth = 0, predicted = 0;  ///< positions in InstanceOverlaps::truth and predicted
  std::int64_t shared = 0;               ///< vertices
  std::int64_t united = 0;               ///< vertices of either

  double iou() const { return static_cast<double>(shared) / static_cast<double>(united); }
  /// Whether the IoU is at least that, in exact arithmetic: 19 of 20 does reach 95 percent.
  bool reaches(int percent) const { return shared * 100 >= percent * united; }
  /// Whether it is more than that.
  bool exceeds(int percent) const { return shared * 100 > percent * united; }
};

/// The table of all instances of two labellings and their overlaps.
struct InstanceOverlaps {
  std::vector<InstanceSize> truth;        ///< by id; sizes over all vertices
  std::vector<InstanceSize> predicted;    ///< by id; sizes over all vertices
  std::vector<InstanceOverlap> overlaps;  ///< sorted by predicted, then truth
  std::vector<std::int64_t> unlabelled;   ///< per predicted: vertices where no truth instance is

  /// The overlaps of one predicted instance.
  std::span<const InstanceOverlap> of_predicted(std::size_t predicted_position) const;
};

/// Which truth ids are no instance.
enum class Background {
  kNotPositive,  ///< 0 and below
  kLowestId,     ///< the lowest id that occurs, whatever it is
};

/// Counts the instances of both labellings, which have the same length. Predicted id 0 is none.
InstanceOverlaps count_overlaps(std::span<const std::int32_t> truth,
                                std::span<const std::uint32_t> predicted, Background background);

}  // namespace ovimap
