// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/map/integrate.h"

#include <algorithm>
#include <cmath>

#include "ovimap/base/parallel.h"
#include "ovimap/base/vectorize.h"
#include "ovimap/map/label_slots.h"

namespace ovimap {

namespace {

constexpr std::size_t kBlocksPerTask = 16;
constexpr float kColorScale = 256.f;            ///< 8.8 fixed point
constexpr float kLeastColorShare = 1.f / 64.f;  ///< colours go on following the view

/// One x-row of eight voxels as the camera sees it.
struct VoxelRow {
  float depth_m[kBlockSide];  ///< of the voxel centre along the optical axis
  float range_m[kBlockSide];  ///< of the voxel centre from the camera
  int pixel[kBlockSide];      ///< index of the nearest pixel, -1 outside the image
};

/// Cosine between viewing ray and surface normal per pixel; 1 where the normal is unknown.
Image<float> incidence_cosines(const Image<Eigen::Vector3f>& normals, const PinholeCamera& camera) {
  constexpr float kLeast = 0.1f;  // normals seen at more than 84 degrees are noise
  Image<float> cosines(normals.width(), normals.height(), 1.f);
  parallel_for(static_cast<std::size_t>(normals.height()), 32, [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < normals.width(); ++x) {
      const Eigen::Vector3f& normal = normals.at(x, y);
      if (normal.isZero()) continue;
      const Eigen::Vector3f ray =
          camera.unproject(static_cast<float>(x), static_cast<float>(y), 1.f);
      cosines.at(x, y) = std::max(kLeast, -normal.dot(ray) / ray.norm());
    }
  });
  return cosines;
}

/// Everything that is the same for all blocks of a frame.
struct View {
  View(const VoxelMapConfig& config, const Observation& observation)
      : observation_(observation),
        camera(observation.camera),
        voxel_size_m(config.voxel_size_m),
        truncation_m(config.truncation_m()),
        max_weight(config.max_weight),
        label_band_m(config.label_band_voxels * config.voxel_size_m) {
    const Pose camera_from_world = observation.world_from_camera.inverse();
    rotation = camera_from_world.linear().cast<float>();
    translation = camera_from_world.translation();
    rotation_double = camera_from_world.linear();
    if (observation.normals) cosines = incidence_cosines(*observation.normals, camera);
  }

  /// Camera coordinates of a block's first voxel centre; in double, as maps may be far from the
  /// origin.
  Eigen::Vector3f block_origin(const BlockIndex& index) const {
    const Eigen::Vector3d first =
        (index.cast<double>() * kBlockSide + Eigen::Vector3d::Constant(0.5)) * double{voxel_size_m};
    return (rotation_double * first + translation).cast<float>();
  }

  const Observation& observation_;
  const PinholeCamera& camera;
  float voxel_size_m, truncation_m, max_weight, label_band_m;
  Eigen::Matrix3f rotation;
  Eigen::Matrix3d rotation_double;
  Eigen::Vector3d translation;
  Image<float> cosines;  ///< empty when the frame has no normals
};

OVIMAP_VECTORIZE void project_row(const PinholeCamera& camera, const float start[3],
                                  const float step[3], VoxelRow& row) {
  const float width = static_cast<float>(camera.width), height = static_cast<float>(camera.height);
  for (int i = 0; i < kBlockSide; ++i) {
    const float along = static_cast<float>(i);
    const float x = start[0] + along * step[0], y = start[1] + along * step[1],
                z = start[2] + along * step[2];
    const float inverse = 1.f / std::max(z, 1e-6f);
    const float u = camera.fx * x * inverse + camera.cx + 0.5f,
                v = camera.fy * y * inverse + camera.cy + 0.5f;
    const bool inside = (z > 1e-3f) & (u >= 0.f) & (v >= 0.f) & (u < width) & (v < height);
    row.depth_m[i] = z;
    row.range_m[i] = std::sqrt(x * x + y * y + z * z);
    row.pixel[i] = inside ? static_cast<int>(v) * camera.width + static_cast<int>(u) : -1;
  }
}

/// Fuses the frame into one block.
class BlockUpdate {
 public:
  BlockUpdate(const View& view, VoxelBlock& block)
      : view_(view), frame_(view.observation_), block_(block) {}

  void run() {
    const Eigen::Vector3f origin = view_.block_origin(block_.index);
    const Eigen::Matrix3f steps = view_.rotation * view_.voxel_size_m;
    for (int z = 0; z < kBlockSide; ++z) {
      for (int y = 0; y < kBlockSide; ++y) {
        const Eigen::Vector3f start =
            origin + steps.col(1) * static_cast<float>(y) + steps.col(2) * static_cast<float>(z);
        VoxelRow row;
        project_row(view_.camera, start.data(), steps.data(), row);
        for (int x = 0; x < kBlockSide; ++x)
          if (row.pixel[x] >= 0)
            update_voxel(static_cast<std::size_t>(voxel_offset(x, y, z)), row, x);
      }
    }
  }

 private:
  void update_voxel(std::size_t voxel, const VoxelRow& row, int x) {
    const auto pixel = static_cast<std::size_t>(row.pixel[x]);
    const float depth = frame_.depth[pixel];
    if (depth <= 0.f) return;
    // Distance along the viewing ray: a difference of depths, stretched by range over depth.
    const float along_ray = (depth - row.depth_m[x]) * row.range_m[x] / row.depth_m[x];
    if (std::fabs(along_ray) >= view_.truncation_m) return;
    const float distance = view_.cosines.empty() ? along_ray : along_ray * view_.cosines[pixel];
    const float weight = observation_weight(depth, distance);
    if (weight <= 0.f) return;
    const float old_weight = block_.weight[voxel], sum = old_weight + weight, share = weight / sum;
    const float old_tsdf = block_.tsdf[voxel];
    const float target = distance / view_.truncation_m * VoxelBlock::kTsdfScale;
    block_.tsdf[voxel] =
        static_cast<VoxelBlock::Tsdf>(std::lrintf(old_tsdf + share * (target - old_tsdf)));
    block_.weight[voxel] = std::min(sum, view_.max_weight);
    if (frame_.color) blend_color(voxel, (*frame_.color)[pixel], share);
    if (frame_.segment_ids && std::fabs(distance) <= view_.label_band_m)
      vote(voxel, (*frame_.segment_ids)[pixel]);
  }

  /// 1/z^2, falling to zero between one voxel and one truncation behind the surface.
  float observation_weight(float depth, float distance) const {
    const float behind =
        (distance + view_.truncation_m) / (view_.truncation_m - view_.voxel_size_m);
    return std::min(1.f, behind) / (depth * depth);
  }

  void blend_color(std::size_t voxel, const Rgb8& color, float share) {
    if (color == Rgb8{}) return;  // unknown
    const float channels[3] = {static_cast<float>(color.r), static_cast<float>(color.g),
                               static_cast<float>(color.b)};
    const bool first =
        (block_.color[0][voxel] | block_.color[1][voxel] | block_.color[2][voxel]) == 0;
    const float mix = first ? 1.f : std::max(share, kLeastColorShare);
    for (std::size_t c = 0; c < 3; ++c) {
      const float old = block_.color[c][voxel];
      block_.color[c][voxel] =
          static_cast<std::uint16_t>(std::lrintf(old + mix * (channels[c] * kColorScale - old)));
    }
  }

  void vote(std::size_t voxel, std::uint16_t segment) {
    if (segment == 0) return;
    if (segment != last_segment_) {  // neighbouring voxels mostly see the same segment
      last_segment_ = segment;
      const Label label = frame_.segment_labels[segment - 1u];
      position_ = label == kNoLabel ? 0 : palette_position(block_, label);
    }
    if (position_ != 0) add_support(block_, static_cast<int>(voxel), position_);
  }

  const View& view_;
  const Observation& frame_;
  VoxelBlock& block_;
  std::uint16_t last_segment_ = 0;
  std::uint8_t position_ = 0;
};

}  // namespace

std::vector<std::uint32_t> integrate(VoxelMap& map, const Observation& observation) {
  std::vector<std::uint32_t> slots =
      allocate_blocks(map, observation.depth, observation.camera, observation.world_from_camera);
  const View view(map.config(), observation);
  parallel_for(slots.size(), kBlocksPerTask, [&](std::size_t i) {
    VoxelBlock& block = map.block(slots[i]);
    resolve_labels(block, map.labels());
    BlockUpdate(view, block).run();
  });
  return slots;
}

}  // namespace ovimap
