// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "ovimap/map/voxels/packed_color.h"

namespace ovimap {

using Label = std::uint32_t;  ///< super-point label; 0 = none
inline constexpr Label kNoLabel = 0;

inline constexpr int kBlockSide = 8;
inline constexpr int kBlockVoxels = kBlockSide * kBlockSide * kBlockSide;
inline constexpr int kLabelSlots = 4;
inline constexpr int kRegionBlocks =
    8;  ///< a region is a cube of 8^3 blocks, for leaping over empty space
inline constexpr float kCubeHalfDiagonal = 0.8660254f;  ///< of a cube with sides of 1

/// Block coordinates: a block covers [index * 8, index * 8 + 8) voxels along each axis.
using BlockIndex = Eigen::Vector3i;

/// Largest integers not above the coordinates. Truncation and a correction: std::floor is a
/// function call on processors without SSE4.1, which the baseline build must assume.
inline Eigen::Vector3i floor_to_int(const Eigen::Vector3f& point) {
  const auto floor_of = [](float value) {
    const int truncated = static_cast<int>(value);
    return truncated - (static_cast<float>(truncated) > value);
  };
  return {floor_of(point.x()), floor_of(point.y()), floor_of(point.z())};
}

/// Block coordinates in one word, 21 bits an axis (+-84 km at blocks of 8 cm); packed words order
/// as (z, y, x).
inline std::uint64_t pack_index(const BlockIndex& index) {
  constexpr int kBias = 1 << 20;
  const auto bits = [](int value) { return static_cast<std::uint64_t>(value + kBias) & 0x1fffff; };
  return bits(index.x()) | bits(index.y()) << 21 | bits(index.z()) << 42;
}
inline BlockIndex unpack_index(std::uint64_t packed) {
  constexpr int kBias = 1 << 20;
  const auto axis = [packed](int shift) {
    return static_cast<int>(packed >> shift & 0x1fffff) - kBias;
  };
  return {axis(0), axis(21), axis(42)};
}

/// For hash tables that take the low bits of a hash: those of packed words are x alone.
struct PackedIndexHash {
  std::size_t operator()(std::uint64_t packed) const {
    packed ^= packed >> 32;
    packed *= 0x9e3779b97f4a7c15ull;
    return static_cast<std::size_t>(packed ^ packed >> 32);
  }
};

/// Voxel within its block: x fastest.
inline int voxel_offset(int x, int y, int z) {
  return x + kBlockSide * (y + kBlockSide * z);
}

/// Weights are whole numbers of such steps, so that sums are exact and take little room in a file.
inline constexpr float kWeightSteps = 1024.f;  ///< in a weight of 1
/// To the nearest step; to one step at least.
inline float round_weight(float weight) {
  return std::max(1.f, std::round(weight * kWeightSteps)) / kWeightSteps;
}

/// One label of each voxel of a block, as a position in the block's palette (0: none), and the
/// votes behind it.
struct LabelSlot {
  std::array<std::uint8_t, kBlockVoxels> label{};
  std::array<std::uint16_t, kBlockVoxels> support{};

  bool operator==(const LabelSlot&) const = default;
};

/// 8 x 8 x 8 voxels, one array per attribute: a stage touches only the cache lines it needs.
/// 10 bytes a voxel, 3 more for each label that some voxel of the block holds, and a palette of
/// the labels that occur in it.
struct VoxelBlock {
  using Tsdf = std::int16_t;
  static constexpr float kTsdfScale = 32767.f;  ///< stored distance 32767 = one truncation distance

  /// What is stored of an observed voxel's distance, rounded to a whole number: not 0, which is
  /// none.
  static Tsdf stored_distance(long rounded) {
    return rounded == 0 ? Tsdf{1} : static_cast<Tsdf>(rounded);
  }

  explicit VoxelBlock(const BlockIndex& block_index) : index(block_index) {
    tsdf.fill(0);
    weight.fill(0.f);
    color.fill(0);
  }

  BlockIndex index;
  std::uint32_t forest_epoch = 0;  ///< merges up to this epoch are already written into the palette
  /// A bit for each row along x of which a voxel may have been observed: whoever looks for surface
  /// need not read the others.
  std::uint64_t observed_rows = 0;
  std::vector<Label> palette{kNoLabel};  ///< labels of the block; slots hold positions in it

  /// Signed distance in truncations, positive in front; 0 = never observed (stored_distance), so
  /// that whoever looks for surface need not read the weights.
  std::array<Tsdf, kBlockVoxels> tsdf;
  std::array<float, kBlockVoxels> weight;  ///< kWeightSteps; 0 = never observed
  std::array<PackedColor, kBlockVoxels> color;
  /// Strongest first. As many as a voxel needed so far, at most kLabelSlots: few blocks need all.
  std::vector<LabelSlot> slots;
  /// In how many frames on end the voxel's surface was seen through (clear_free_space); empty: in
  /// none, as in most blocks.
  std::vector<std::uint8_t> doubts;

  /// To be called of every voxel that gets a weight.
  void note_observed(std::size_t voxel) { observed_rows |= std::uint64_t{1} << voxel / kBlockSide; }
  /// The voxel is as never observed.
  void forget(std::size_t voxel) {
    tsdf[voxel] = 0;
    weight[voxel] = 0.f;
    color[voxel] = 0;
    for (LabelSlot& slot : slots) slot.label[voxel] = slot.support[voxel] = 0;
    if (!doubts.empty()) doubts[voxel] = 0;
  }

  /// The position in the palette of the strongest label of a voxel.
  std::uint8_t strongest(std::size_t voxel) const {
    return slots.empty() ? std::uint8_t{0} : slots.front().label[voxel];
  }
  /// To write to it; added where there is none yet.
  LabelSlot& slot(std::size_t number) {
    if (number >= slots.size()) {
      slots.reserve(number + 1);  // not twice as many
      slots.resize(number + 1);
    }
    return slots[number];
  }

  /// Whether any voxel is doubted.
  bool doubted() const {
    return std::any_of(doubts.begin(), doubts.end(), [](std::uint8_t count) { return count != 0; });
  }

  /// Of memory, its palette included.
  std::size_t bytes() const {
    return sizeof(VoxelBlock) + slots.capacity() * sizeof(LabelSlot) +
           palette.capacity() * sizeof(Label) + doubts.capacity();
  }
  /// What a block of voxels with all labels takes, but for its palette and doubts: by this memory
  /// is bounded, since nobody knows how many labels frames will show.
  static const std::size_t kMostBytes;
};
inline constexpr std::size_t VoxelBlock::kMostBytes =
    sizeof(VoxelBlock) + kLabelSlots * sizeof(LabelSlot);

}  // namespace ovimap
