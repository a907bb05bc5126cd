// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/map/fusion/map_fusion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/Geometry>

#include "ovimap/base/parallel.h"
#include "ovimap/map/rays/surface_lookup.h"
#include "ovimap/map/voxels/label_slots.h"

namespace ovimap {

namespace {

constexpr std::size_t kFusedBlocksPerTask = 8;

/// What a map says of a place.
struct Sample {
  float distance_m = 0;
  float weight = 0;
  std::array<float, 3> color{};  ///< 8.8 fixed point
  bool colored = false;
  VoxelLabels labels{};
};

/// Reads another map at the voxels of this one. One per thread.
class Sampler {
 public:
  Sampler(const VoxelMap& map, const VoxelMap& other, const Pose& map_from_other)
      : other_(other),
        finder_(other),
        voxel_in_map_m_(map.config().voxel_size_m),
        voxels_per_m_(1.f / other.config().voxel_size_m),
        other_from_map_(map_from_other.inverse().cast<float>()),
        coincide_(map.config().voxel_size_m == other.config().voxel_size_m &&
                  map_from_other.matrix().isIdentity(1e-9)) {}

  std::optional<Sample> at(const Eigen::Vector3i& voxel) {
    if (coincide_) return read(voxel, true);
    const Eigen::Vector3f center = (voxel.cast<float>().array() + 0.5f).matrix() * voxel_in_map_m_;
    return interpolate(other_from_map_ * center * voxels_per_m_);
  }

 private:
  std::optional<Sample> read(const Eigen::Vector3i& voxel, bool with_labels) {
    if (!finder_.seek(voxel)) return std::nullopt;
    const VoxelBlock& block = finder_.block();
    const auto v = static_cast<std::size_t>(finder_.voxel());
    if (block.weight[v] <= 0.f) return std::nullopt;
    Sample sample;
    sample.distance_m = finder_.distance_m();
    sample.weight = block.weight[v];
    const FixedColor color = unpack_color(block.color[v]);
    std::copy(color.begin(), color.end(), sample.color.begin());
    sample.colored = block.color[v] != 0;
    if (with_labels) sample.labels = voxel_labels(block, finder_.voxel(), other_.labels());
    return sample;
  }

  /// `place` in voxels; the centre of voxel (0, 0, 0) is at (0.5, 0.5, 0.5).
  std::optional<Sample> interpolate(const Eigen::Vector3f& place) {
    const Eigen::Vector3i nearest = floor_to_int(place);
    std::optional<Sample> result = read(nearest, true);
    if (!result) return std::nullopt;
    const Eigen::Vector3i low = floor_to_int((place.array() - 0.5f).matrix());
    const Eigen::Vector3f share = (place.array() - 0.5f).matrix() - low.cast<float>();
    Sample sum;
    float colored = 0.f;
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3i offset(corner & 1, corner >> 1 & 1, corner >> 2);
      const auto part = read(low + offset, false);
      if (!part) return std::nullopt;
      float factor = 1.f;
      for (int axis = 0; axis < 3; ++axis)
        factor *= offset[axis] != 0 ? share[axis] : 1.f - share[axis];
      sum.distance_m += factor * part->distance_m;
      sum.weight += factor * part->weight;
      if (!part->colored) continue;
      colored += factor;
      for (std::size_t c = 0; c < 3; ++c) sum.color[c] += factor * part->color[c];
    }
    result->distance_m = sum.distance_m;
    result->weight = sum.weight;
    result->colored = colored > 0.f;
    for (std::size_t c = 0; c < 3; ++c)
      result->color[c] = result->colored ? sum.color[c] / colored : 0.f;
    return result;
  }

  const VoxelMap& other_;
  VoxelFinder finder_;
  float voxel_in_map_m_, voxels_per_m_;
  Eigen::Isometry3f other_from_map_;
  bool coincide_;
};

/// The blocks of `map` that the blocks of `other` reach into.
std::vector<BlockIndex> reached_blocks(const VoxelMap& map, const VoxelMap& other,
                                       const Pose& map_from_other) {
  const Eigen::Isometry3f pose = map_from_other.cast<float>();
  const float size = map.config().block_size_m(), other_size = other.config().block_size_m();
  std::vector<std::uint64_t> keys;
  for (std::uint32_t slot = 0; slot < other.block_count(); ++slot) {
    Eigen::AlignedBox3f box;
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3i offset(corner & 1, corner >> 1 & 1, corner >> 2);
      box.extend(pose * ((other.block_index(slot) + offset).cast<float>() * other_size));
    }
    const float border = 1e-4f * size;
    const BlockIndex low = block_at((box.min().array() + border).matrix(), 1.f / size),
                     high = block_at((box.max().array() - border).matrix(), 1.f / size);
    for (int z = low.z(); z <= high.z(); ++z)
      for (int y = low.y(); y <= high.y(); ++y)
        for (int x = low.x(); x <= high.x(); ++x) keys.push_back(pack_index({x, y, z}));
  }
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  std::vector<BlockIndex> blocks;
  for (const std::uint64_t key : keys) blocks.push_back(unpack_index(key));
  return blocks;
}

Eigen::Vector3i voxel_of(const BlockIndex& block, int v) {
  return block * kBlockSide + Eigen::Vector3i(v & 7, v >> 3 & 7, v >> 6);
}

void fuse_color(VoxelBlock& block, std::size_t v, const Sample& sample, float own_weight) {
  if (!sample.colored) return;
  const float share = block.color[v] != 0 ? sample.weight / (own_weight + sample.weight) : 1.f;
  FixedColor color = unpack_color(block.color[v]);
  for (std::size_t c = 0; c < color.size(); ++c) {
    const float own = color[c];
    const float mixed = own + share * (sample.color[c] - own);
    color[c] = static_cast<std::uint16_t>(std::clamp(std::lround(mixed), 0l, 65535l));
  }
  block.color[v] = pack_color(color);
}

/// Sums the supports of both and keeps the strongest; of equals those that were there.
void fuse_labels(VoxelBlock& block, int voxel, const VoxelLabels& added, Label offset,
                 const LabelForest& forest) {
  if (added[0].label == kNoLabel) return;
  std::vector<LabelSupport> all;
  for (const LabelSupport& own : voxel_labels(block, voxel, forest))
    if (own.label != kNoLabel) all.push_back(own);
  for (const LabelSupport& other : added) {
    if (other.label == kNoLabel) continue;
    const Label label = forest.root(other.label + offset);
    const auto same = std::find_if(all.begin(), all.end(),
                                   [&](const LabelSupport& held) { return held.label == label; });
    if (same == all.end())
      all.push_back({label, other.support});
    else
      same->support += other.support;
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return a.support > b.support; });
  constexpr std::uint32_t kMost = std::numeric_limits<std::uint16_t>::max();
  const auto v = static_cast<std::size_t>(voxel);
  std::size_t used = 0;
  const auto put = [&](std::uint8_t position, std::uint32_t support) {
    LabelSlot& slot = block.slot(used++);
    slot.label[v] = position;
    slot.support[v] = static_cast<std::uint16_t>(std::min(support, kMost));
  };
  for (std::size_t i = 0; i < all.size() && used < kLabelSlots; ++i)
    if (const std::uint8_t position = palette_position(block, all[i].label); position != 0)
      put(position, all[i].support);
  while (used < block.slots.size()) put(0, 0);
}

void fuse_voxel(const VoxelMap& map, VoxelBlock& block, int voxel, const Sample& sample,
                Label offset) {
  const auto v = static_cast<std::size_t>(voxel);
  const float own = block.weight[v], total = own + sample.weight;
  const float truncation = map.config().truncation_m();
  const float distance =
      (own * map.distance_m(block, voxel) + sample.weight * sample.distance_m) / total;
  const float units = VoxelBlock::kTsdfScale * std::clamp(distance / truncation, -1.f, 1.f);
  block.tsdf[v] = VoxelBlock::stored_distance(std::lround(units));
  fuse_color(block, v, sample, own);
  block.weight[v] = round_weight(std::min(total, map.config().max_weight));
  block.note_observed(v);
  if (!block.doubts.empty()) block.doubts[v] = 0;
  fuse_labels(block, voxel, sample.labels, offset, map.labels());
}

}  // namespace

Label append_labels(VoxelMap& map, const LabelForest& other) {
  const Label offset = map.labels().last_label();
  std::vector<Label> roots = map.labels().roots();
  for (std::size_t label = 1; label < other.roots().size(); ++label)
    roots.push_back(other.roots()[label] + offset);
  map.labels() = LabelForest::from_roots(std::move(roots), map.labels().epoch() + other.epoch());
  return offset;
}

void fuse_map(VoxelMap& map, const VoxelMap& other, const Pose& map_from_other,
              Label label_offset) {
  const std::vector<BlockIndex> reached = reached_blocks(map, other, map_from_other);
  std::vector<std::uint8_t> wanted(reached.size(), 0);
  parallel_for_ranges(reached.size(), kFusedBlocksPerTask, [&](std::size_t begin, std::size_t end) {
    Sampler sampler(map, other, map_from_other);
    for (std::size_t i = begin; i < end; ++i)
      for (int v = 0; v < kBlockVoxels && wanted[i] == 0; ++v)
        wanted[i] = sampler.at(voxel_of(reached[i], v)).has_value();
  });
  std::vector<std::uint32_t> slots;
  for (std::size_t i = 0; i < reached.size(); ++i)
    if (wanted[i] != 0) slots.push_back(map.find_or_create(reached[i]));
  parallel_for_ranges(slots.size(), kFusedBlocksPerTask, [&](std::size_t begin, std::size_t end) {
    Sampler sampler(map, other, map_from_other);
    for (std::size_t i = begin; i < end; ++i) {
      VoxelBlock& block = map.writable_block(slots[i]);
      resolve_labels(block, map.labels());
      for (int v = 0; v < kBlockVoxels; ++v)
        if (const auto sample = sampler.at(voxel_of(block.index, v)))
          fuse_voxel(map, block, v, *sample, label_offset);
    }
  });
}

}  // namespace ovimap
