// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace ovimap {

/// Bins of directions: rows of the polar angle from +z, columns of the azimuth from -pi (paper
/// section 3.2; both angles are clamped into the grid).
struct SphereGrid {
  int rows = 24;
  int columns = 32;

  int bins() const { return rows * columns; }
  bool operator==(const SphereGrid&) const = default;
};

/// The bin of a direction of any length; -1 for a zero or non-finite one. The plain version of
/// mark_directions.
int bin_of(const SphereGrid& grid, const Eigen::Vector3f& direction);

/// A set of bins as bits.
class BinSet {
 public:
  BinSet() = default;
  explicit BinSet(int bins) : words_((static_cast<std::size_t>(bins) + 63) / 64) {}
  /// From stored words; nothing where they are not those of a set of so many bins.
  static std::optional<BinSet> from_words(std::vector<std::uint64_t> words, int bins);

  void set(int bin) {
    words_[static_cast<std::size_t>(bin) / 64] |= std::uint64_t{1} << (bin % 64);
  }
  bool has(int bin) const { return words_[static_cast<std::size_t>(bin) / 64] >> (bin % 64) & 1; }
  bool empty() const { return words_.empty(); }
  int count() const;
  /// Bins of this set that `other` lacks. Both have the same number of bins.
  int count_outside(const BinSet& other) const;
  BinSet& operator|=(const BinSet& other);
  const std::vector<std::uint64_t>& words() const { return words_; }
  bool operator==(const BinSet&) const = default;

 private:
  std::vector<std::uint64_t> words_;
};

/// Coordinates of many directions, each array equally long.
struct Directions {
  std::span<const float> x, y, z;
};

/// Sets the bins of all directions. Angles are good to 3e-7 rad, so a direction that close to a
/// boundary may go to the neighbouring bin.
void mark_directions(const SphereGrid& grid, const Directions& directions, BinSet& bins);

}  // namespace ovimap
