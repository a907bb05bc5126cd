// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
//
// How far a map's surface is from the truth when only as much of it is shown as another surface
// has, the best known first, and how much it has of what the recording shows well.
//   ovimap_surface_curve MAP SCENE [COMPLETENESS...]
// One JSON object: "curve" has for each completeness the error of the best known vertices that are
// as complete (a vertex is known as well as the voxels that it lies between); "known" is the share
// of true vertices of which all frames together would tell the depth to 10 mm if each erred by
// itself, and "completeness_of_known" the share of those near which the map has surface.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <map>
#include <numeric>
#include <tuple>
#include <vector>

#include "ovimap/base/parallel.h"
#include "ovimap/eval/geometry/geometry_scores.h"
#include "ovimap/eval/geometry/surface_distance.h"
#include "ovimap/frames/frame/frame_source.h"
#include "ovimap/io/map_file/map_file.h"
#include "ovimap/io/truth/truth.h"
#include "ovimap/map/surface/mesh_extraction.h"
#include "ovimap/segment/depth_surface.h"

namespace {

using namespace ovimap;

constexpr float kKnown_m = 0.01f;
constexpr float kSameSurfaceSigmas = 5.f, kSameSurface_m = 0.02f;

/// The weight of the lighter of the two voxels that a vertex of the mesh lies between.
float weight_at(const VoxelMap& map, const Eigen::Vector3f& vertex) {
  constexpr float kOnVoxel = 1e-2f;
  const Eigen::Vector3f at = vertex / map.config().voxel_size_m - Eigen::Vector3f::Constant(0.5f);
  Eigen::Vector3i low, high;
  for (int axis = 0; axis < 3; ++axis) {
    const float nearest = std::round(at[axis]);
    const bool on = std::fabs(at[axis] - nearest) < kOnVoxel;
    low[axis] = static_cast<int>(on ? nearest : std::floor(at[axis]));
    high[axis] = on ? low[axis] : low[axis] + 1;
  }
  const auto weight_of = [&map](const Eigen::Vector3i& voxel) {
    const BlockIndex index = (voxel.cast<float>() / float{kBlockSide}).array().floor().cast<int>();
    const VoxelBlock* block = map.find(index);
    if (block == nullptr) return 0.f;
    const Eigen::Vector3i in = voxel - index * kBlockSide;
    return block
        ->weight[static_cast<std::size_t>(in.x() + kBlockSide * (in.y() + kBlockSide * in.z()))];
  };
  return std::min(weight_of(low), weight_of(high));
}

/// Of each true vertex, the weight of the best known vertex of the map that is near; -1: none is.
std::vector<float> best_near(const Mesh& truth, const Mesh& mesh, const std::vector<float>& weights,
                             float near_m) {
  const auto cell_of = [near_m](const Eigen::Vector3f& p) {
    return std::tuple(static_cast<int>(std::floor(p.x() / near_m)),
                      static_cast<int>(std::floor(p.y() / near_m)),
                      static_cast<int>(std::floor(p.z() / near_m)));
  };
  std::map<std::tuple<int, int, int>, std::vector<std::size_t>> cells;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    cells[cell_of(mesh.vertices[i])].push_back(i);
  std::vector<float> best(truth.vertices.size(), -1.f);
  parallel_for(best.size(), 256, [&](std::size_t i) {
    const Eigen::Vector3f& point = truth.vertices[i];
    const auto [x, y, z] = cell_of(point);
    for (int dx = -1; dx <= 1; ++dx)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dz = -1; dz <= 1; ++dz)
          if (const auto found = cells.find({x + dx, y + dy, z + dz}); found != cells.end())
            for (const std::size_t k : found->second)
              if (weights[k] > best[i] && (mesh.vertices[k] - point).norm() <= near_m)
                best[i] = weights[k];
  });
  return best;
}

/// Whether all frames together tell the depth of each true vertex.
std::vector<bool> known(const Mesh& truth, const FrameSource& source) {
  const DepthNoiseConfig noise;
  std::vector<float> information(truth.vertices.size(), 0.f);
  for (std::int64_t i = 0; i < source.size(); ++i) {
    const FrameRead read = source.read(i);
    if (!read.frame) continue;
    const Frame& frame = *read.frame;
    const Eigen::Isometry3f camera_from_world = frame.world_from_camera.inverse().cast<float>();
    parallel_for(truth.vertices.size(), 4096, [&](std::size_t v) {
      const Eigen::Vector3f point = camera_from_world * truth.vertices[v];
      if (point.z() <= 0.f) return;
      const Eigen::Vector2f pixel = frame.depth_camera.project(point);
      const int x = static_cast<int>(std::lround(pixel.x())),
                y = static_cast<int>(std::lround(pixel.y()));
      if (!frame.depth.contains(x, y) || frame.depth.at(x, y) <= 0.f) return;
      const float sigma_m = noise.sigma_m(point.z());
      if (std::fabs(frame.depth.at(x, y) - point.z()) <
          kSameSurface_m + kSameSurfaceSigmas * sigma_m)
        information[v] += 1.f / (sigma_m * sigma_m);
    });
  }
  std::vector<bool> result;
  for (const float sum : information) result.push_back(sum >= 1.f / (kKnown_m * kKnown_m));
  return result;
}

/// The error of the vertices that are known so well.
void print_errors(const std::vector<float>& errors_m, const std::vector<float>& weights,
                  double completeness, float least_weight, float limit_m) {
  std::vector<float> shown;
  std::size_t stray = 0;
  for (std::size_t i = 0; i < errors_m.size(); ++i) {
    if (weights[i] < least_weight) continue;
    if (errors_m[i] > limit_m)
      ++stray;
    else
      shown.push_back(errors_m[i]);
  }
  if (shown.empty()) shown.push_back(limit_m);
  const auto middle = shown.begin() + static_cast<std::ptrdiff_t>((shown.size() - 1) / 2);
  std::nth_element(shown.begin(), middle, shown.end());
  std::printf(
      "{\"completeness\": %.4f, \"weight\": %.4g, \"median_m\": %.6f, \"mean_m\": %.6f, \"stray\": "
      "%.5f}",
      completeness, double{least_weight}, double{*middle},
      std::accumulate(shown.begin(), shown.end(), 0.) / static_cast<double>(shown.size()),
      static_cast<double>(stray) / static_cast<double>(stray + shown.size()));
}

void print_curve(const char* map_path, const char* scene, std::vector<double> wanted) {
  const GeometryScoresConfig config;
  const Truth truth = load_truth(scene);
  const MapDocument map = load_map(map_path);
  const Mesh mesh = extract_mesh(map.map);
  std::vector<float> weights(mesh.vertices.size()), errors_m(mesh.vertices.size());
  const SurfaceDistance surface(truth.mesh);
  parallel_for(mesh.vertices.size(), 512, [&](std::size_t i) {
    weights[i] = weight_at(map.map, mesh.vertices[i]);
    errors_m[i] = surface.find(mesh.vertices[i], config.accuracy_limit_m).value_or(1e9f);
  });
  const std::vector<float> best = best_near(truth.mesh, mesh, weights, config.completeness_m);
  const std::vector<bool> told = known(truth.mesh, *open_frame_source(scene));
  std::size_t of_known = 0, covered = 0;
  for (std::size_t i = 0; i < best.size(); ++i)
    if (told[i]) ++of_known, covered += best[i] >= 0.f;
  if (best.empty()) throw Error("the truth has no surface");
  std::vector<float> ranked = best;
  std::sort(ranked.begin(), ranked.end(), std::greater<>());
  std::printf(
      "{\"known\": %.4f, \"completeness_of_known\": %.4f, \"curve\": [",
      static_cast<double>(of_known) / static_cast<double>(best.size()),
      static_cast<double>(covered) / static_cast<double>(std::max<std::size_t>(of_known, 1)));
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const auto rank = static_cast<std::size_t>(wanted[i] * static_cast<double>(ranked.size()));
    if (i > 0) std::printf(", ");
    const float least = std::max(0.f, ranked[std::min(rank, ranked.size() - 1)]);
    const auto shown = std::count_if(best.begin(), best.end(), [&](float w) { return w >= least; });
    print_errors(errors_m, weights, static_cast<double>(shown) / static_cast<double>(best.size()),
                 least, config.accuracy_limit_m);
  }
  std::printf("]}\n");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: ovimap_surface_curve MAP SCENE [COMPLETENESS...]\n");
    return 2;
  }
  try {
    std::vector<double> wanted;
    for (int i = 3; i < argc; ++i) wanted.push_back(std::atof(argv[i]));
    print_curve(argv[1], argv[2], std::move(wanted));
  } catch (const std::exception& fault) {
    std::fprintf(stderr, "ovimap_surface_curve: %s\n", fault.what());
    return 2;
  }
}
