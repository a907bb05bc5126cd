// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace ovimap {

/// Exact nearest neighbours among a fixed set of points (a balanced k-d tree). Answers do not
/// depend on thread count or memory layout: of equally near points the one with the lowest index
/// wins.
class NearestPoints {
 public:
  struct Neighbor {
    std::uint32_t index = 0;  ///< into the points given at construction
    float distance_m = 0;
    bool operator==(const Neighbor&) const = default;
  };

  /// Copies the points (finite, at most 2^32 - 1).
  explicit NearestPoints(std::span<const Eigen::Vector3f> points);

  /// The nearest point at most `radius_m` away; nullopt when there is none. Thread-safe.
  [[nodiscard]] std::optional<Neighbor> find(const Eigen::Vector3f& query, float radius_m) const;

  /// The same for many queries, in parallel.
  std::vector<std::optional<Neighbor>> find_all(std::span<const Eigen::Vector3f> queries,
                                                float radius_m) const;

 private:
  struct Entry {
    Eigen::Vector3f point;
    std::uint32_t index;
  };
  struct Best;

  void build(std::size_t begin, std::size_t end);
  void search(std::size_t begin, std::size_t end, Best& best) const;

  // The root of a range is its middle entry; its halves are the children.
  std::vector<Entry> entries_;
  std::vector<std::uint8_t> split_axis_;  // per root entry
};

}  // namespace ovimap
