// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/motion/moving_pixels.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "ovimap/base/config.h"
#include "ovimap/map/fusion/seen_ahead.h"
#include "ovimap/map/rays/surface_lookup.h"
#include "ovimap/pipeline/motion/contradicting_pixels.h"
#include "ovimap/pipeline/motion/frame_points.h"

namespace ovimap {

namespace {

constexpr double kNearlyAll = 0.75;  // of what a frame shows
constexpr std::uint16_t kMostPatches = MovingPixels::kTakenOut - 1;

/// Patches grown from the pixels that contradict, one after another in the order of their first.
class PatchFinder {
 public:
  PatchFinder(const VoxelMap& map, const SeenFree& space, const Observation& seen,
              const Image<std::uint8_t>& seeds, const MotionConfig& config)
      : seen_(seen),
        seeds_(seeds),
        config_(config),
        points_(seen),
        finder_(map),
        space_(space),
        near_m_(kOnSurface_voxels * map.config().voxel_size_m),
        inverse_cell_(1.f / map.config().block_size_m()),
        ids_(seen.depth.width(), seen.depth.height()) {}

  MovingPixels find() {
    MovingPixels result;
    Image<std::uint8_t> tried(ids_.width(), ids_.height());
    for (int pixel = 0; pixel < static_cast<int>(seeds_.size()); ++pixel) {
      if (!seeds_[place(pixel)] || tried[place(pixel)] || patches_.size() == kMostPatches) continue;
      const std::vector<int> core = connected_seeds(pixel, tried);
      if (large_enough(core)) take(core);
    }
    if (patches_.empty()) return result;
    grow();
    take_edges();
    measure();
    result.ids = std::move(ids_);
    result.patches = std::move(patches_);
    return result;
  }

 private:
  static std::size_t place(int pixel) { return static_cast<std::size_t>(pixel); }

  template <class Visit>
  void for_neighbours(int pixel, const Visit& visit) const {
    const int width = ids_.width(), x = pixel % width;
    if (x > 0) visit(pixel - 1);
    if (x + 1 < width) visit(pixel + 1);
    if (pixel >= width) visit(pixel - width);
    if (pixel + width < static_cast<int>(ids_.size())) visit(pixel + width);
  }
  bool goes_on(int from, int to) const {
    const float a = seen_.depth[place(from)], b = seen_.depth[place(to)];
    return b > 0.f && std::fabs(a - b) < config_.step_share * std::min(a, b);
  }

  std::vector<int> connected_seeds(int first, Image<std::uint8_t>& tried) const {
    std::vector<int> pixels{first};
    tried[place(first)] = 1;
    for (std::size_t i = 0; i < pixels.size(); ++i)
      for_neighbours(pixels[i], [&, from = pixels[i]](int to) {
        if (!seeds_[place(to)] || tried[place(to)] || !goes_on(from, to)) return;
        tried[place(to)] = 1;
        pixels.push_back(to);
      });
    return pixels;
  }
  bool large_enough(const std::vector<int>& pixels) const {
    double area_m2 = 0;
    for (const int pixel : pixels) {
      const auto depth = static_cast<double>(seen_.depth[place(pixel)]);
      area_m2 += depth * depth;
    }
    area_m2 /= static_cast<double>(seen_.camera.fx) * static_cast<double>(seen_.camera.fy);
    return pixels.size() >= static_cast<std::size_t>(config_.least_px) &&
           area_m2 >= static_cast<double>(config_.least_area_m2);
  }
  void take(const std::vector<int>& pixels) {
    patches_.emplace_back().core_px = static_cast<int>(pixels.size());
    for (const int pixel : pixels) {
      ids_[place(pixel)] = static_cast<std::uint16_t>(patches_.size());
      front_.push_back({pixel, points_.at(pixel)});
    }
  }

  /// Along surfaces, as far as the map does not know them, and over steps to what hangs behind.
  void grow() {
    for (std::size_t i = 0; i < front_.size(); ++i) {
      const Reached from = front_[i];
      const Eigen::Vector3f point = points_.at(from.pixel);
      for_neighbours(from.pixel, [&](int to) {
        if (ids_[place(to)] != 0 || seen_.depth[place(to)] <= 0.f) return;
        const Eigen::Vector3f next = points_.at(to);
        if ((next - from.start).norm() > config_.grow_m || is_known(next)) return;
        if (!goes_on(from.pixel, to) && !hangs_behind(point, next)) return;
        ids_[place(to)] = ids_[place(from.pixel)];
        front_.push_back({to, from.start});
      });
    }
  }
  /// What somebody carries hides where the rest of her goes on.
  bool hangs_behind(const Eigen::Vector3f& point, const Eigen::Vector3f& next) {
    return (next - point).norm() < config_.behind_m &&
           is_fresh(space_.at(block_at(next, inverse_cell_)), config_);
  }
  bool is_known(const Eigen::Vector3f& point) {
    return !is_fresh(space_.at(block_at(point, inverse_cell_)), config_) && finder_.seek(point) &&
           finder_.observed() && std::fabs(finder_.distance_m()) < near_m_;
  }

  void take_edges() {
    std::vector<int> edge;
    for (const auto& [pixel, start] : front_) edge.push_back(pixel);
    for (int step = 0; step < config_.edge_px; ++step) {
      std::vector<int> next;
      for (const int from : edge)
        for_neighbours(from, [&](int to) {
          if (ids_[place(to)] != 0) return;
          ids_[place(to)] = ids_[place(from)];
          next.push_back(to);
        });
      edge = std::move(next);
    }
  }

  /// Without the edges, whose depth is anything.
  void measure() {
    for (const auto& [pixel, start] : front_) {
      MovingPatch& patch = patches_[ids_[place(pixel)] - 1u];
      const Eigen::Vector3f point = points_.at(pixel);
      ++patch.area_px;
      patch.box.extend(point);
      patch.centroid += point;
    }
    for (MovingPatch& patch : patches_) patch.centroid /= static_cast<float>(patch.area_px);
  }

  struct Reached {
    int pixel;
    Eigen::Vector3f start;  ///< which of the points that contradict it hangs together with
  };
  const Observation& seen_;
  const Image<std::uint8_t>& seeds_;
  const MotionConfig& config_;
  FramePoints points_;
  VoxelFinder finder_;
  SpaceFinder space_;
  float near_m_, inverse_cell_;
  IdImage ids_;
  std::vector<Reached> front_;
  std::vector<MovingPatch> patches_;
};

std::vector<BlockIndex> cells_of(const Image<std::uint8_t>& seeds, const Observation& seen,
                                 float cell_m) {
  const FramePoints points(seen);
  std::vector<std::uint64_t> keys;
  for (std::size_t i = 0; i < seeds.size(); ++i)
    if (seeds[i]) {
      const std::uint64_t key = pack_index(block_at(points.at(static_cast<int>(i)), 1.f / cell_m));
      if (keys.empty() || keys.back() != key) keys.push_back(key);
    }
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  std::vector<BlockIndex> cells;
  for (const std::uint64_t key : keys) cells.push_back(unpack_index(key));
  return cells;
}

}  // namespace

void list_fields(MotionConfig& config, ConfigFields& fields) {
  fields.add_choice(
      "mode", config.mode,
      {{"off", DynamicMode::kOff}, {"drop", DynamicMode::kDrop}, {"track", DynamicMode::kTrack}},
      "things that move are fused (off), left out (drop), or left out and followed");
  fields.add("looks", config.looks, 1, 255,
             "so many looks through a place, then surface in it moves");
  fields.add("look_step_m", config.look_step_m, 0.f, 10.f,
             "frames are looks of their own when the camera has moved this far, metres");
  fields.add("look_turn_rad", config.look_turn_rad, 0.f, 3.f, "or turned this far, radians");
  fields.add("look_s", config.look_s, 0.f, 100.f, "or after so long, seconds");
  fields.add("margin_voxels", config.margin_voxels, 0.f, 100.f,
             "so far behind the surface must be seen empty as well, voxels");
  fields.add("sigmas", config.sigmas, 0.f, 100.f, "the same in standard deviations of the depth");
  fields.add("least_px", config.least_px, 1, 1000000, "smaller patches stand still, pixels");
  fields.add("least_area_m2", config.least_area_m2, 0.f, 10.f, "likewise, square metres");
  fields.add("step_share", config.step_share, 0.f, 1.f,
             "neighbours that differ by more of their depth are not one surface");
  fields.add("grow_m", config.grow_m, 0.f, 10.f,
             "what hangs together with a moving patch and is no further moves too, metres");
  fields.add("behind_m", config.behind_m, 0.f, 10.f,
             "that over steps of depth of so much as well, metres");
  fields.add("known_s", config.known_s, 0.f, 8.f,
             "surface that was seen for less long stops nothing of that, seconds");
  fields.add("beside_m", config.beside_m, 0.f, 10.f,
             "and goes as soon as it is seen through, where something moved so near, metres");
  fields.add("back_guard_px", config.back_guard_px, 1, 64,
             "by rays so far around, up to twice as far, pixels");
  fields.add("edge_px", config.edge_px, 0, 64,
             "pixels around what moves that are left out as well");
  fields.add("stays_s", config.stays_s, 0.1f, 8.f,
             "what stands still for so long is part of the place, seconds");
  fields.add("same_thing_m", config.same_thing_m, 0.f, 10.f,
             "tracks: patches nearer to each other are of one thing, metres");
  fields.add("fastest_mps", config.fastest_mps, 0.f, 100.f,
             "tracks: how fast a thing may be, metres a second");
  fields.add("forget_s", config.forget_s, 0.f, 1000.f,
             "tracks: what was not seen for so long is another thing, seconds");
}

MovingPixels find_moving(const VoxelMap& map, const SeenFree& space, const Observation& seen,
                         const MotionConfig& config) {
  OVIMAP_ASSERT(seen.sigma_m != nullptr && seen.plane_slope != nullptr);
  if (space.regions().empty()) return {};
  const Image<std::uint8_t> seeds = contradicting_pixels(map.config(), space, seen, config);
  std::vector<BlockIndex> cells = cells_of(seeds, seen, map.config().block_size_m());
  if (cells.empty()) return {};
  MovingPixels moving = PatchFinder(map, space, seen, seeds, config).find();
  moving.cells = std::move(cells);
  double moving_px = 0;  // what hangs together with them may be more, where little is known
  for (const MovingPatch& patch : moving.patches) moving_px += patch.core_px;
  const auto known_px = std::count_if(seen.depth.begin(), seen.depth.end(),
                                      [](float depth_m) { return depth_m > 0.f; });
  const bool all = moving_px >= kNearlyAll * static_cast<double>(known_px);  // a hand on the lens
  if (moving_px > 0 && !all && moving_px > confirmed_px(map, seen)) {
    moving.refused = true;
    moving.ids = {};
    moving.patches.clear();
  }
  return moving;
}

}  // namespace ovimap
