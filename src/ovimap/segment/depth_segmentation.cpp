// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/segment/depth_segmentation.h"

#include <algorithm>
#include <limits>

#include "ovimap/base/config.h"
#include "ovimap/base/parallel.h"
#include "ovimap/segment/concave_edges.h"
#include "ovimap/segment/connected_regions.h"

namespace ovimap {

namespace {

constexpr std::size_t kRowsPerTask = 16;
constexpr std::uint32_t kNoSeed = std::numeric_limits<std::uint32_t>::max();

/// Pixels whose surface goes on to all four neighbours and that touch no concave edge: what regions
/// grow from.
Image<std::uint8_t> find_interior(const DepthSurface& surface, const Image<std::uint8_t>& concave) {
  const int width = concave.width(), height = concave.height();
  Image<std::uint8_t> interior(width, height);
  parallel_for(
      static_cast<std::size_t>(std::max(0, height - 2)), kRowsPerTask, [&](std::size_t row) {
        const int y = static_cast<int>(row) + 1;
        const std::uint8_t *above = concave.row(y - 1), *here = concave.row(y),
                           *below = concave.row(y + 1);
        const std::uint8_t *breaks = surface.breaks.row(y),
                           *breaks_above = surface.breaks.row(y - 1);
        for (int x = 1; x < width - 1; ++x) {
          const int broken = breaks[x] | (breaks[x - 1] & DepthSurface::kRight) |
                             (breaks_above[x] & DepthSurface::kBelow);
          const int folded = above[x - 1] | above[x] | above[x + 1] | here[x - 1] | here[x] |
                             here[x + 1] | below[x - 1] | below[x] | below[x + 1];
          interior.at(x, y) = broken == 0 && folded == 0;
        }
      });
  return interior;
}

/// Gives pixels between regions to the region whose nearest interior pixel is nearest in 3D.
class Regrowth {
 public:
  Regrowth(const DepthSurface& surface, const PinholeCamera& camera,
           const SegmentDepthConfig& config, Image<std::uint32_t>& labels)
      : surface_(surface),
        camera_(camera),
        config_(config),
        labels_(labels),
        seeds_(labels.width(), labels.height(), kNoSeed) {
    for (std::size_t i = 0; i < labels.size(); ++i) {
      if (labels[i] != 0)
        seeds_[i] = static_cast<std::uint32_t>(i);
      else if (surface.smooth_depth_m[i] > 0.f)
        open_.push_back(static_cast<std::uint32_t>(i));
    }
  }

  /// One ring of pixels further; returns whether anything grew.
  bool grow() {
    std::vector<std::uint32_t> found(open_.size(), kNoSeed);
    parallel_for(open_.size(), 4096, [&](std::size_t i) { found[i] = nearest_seed(open_[i]); });
    std::vector<std::uint32_t> still_open;
    for (std::size_t i = 0; i < open_.size(); ++i) {
      if (found[i] == kNoSeed) {
        still_open.push_back(open_[i]);
        continue;
      }
      seeds_[open_[i]] = found[i];
      labels_[open_[i]] = labels_[found[i]];
    }
    const bool grew = still_open.size() < open_.size();
    open_ = std::move(still_open);
    return grew;
  }

 private:
  Eigen::Vector3f point(std::uint32_t index) const {
    const auto width = static_cast<std::uint32_t>(labels_.width());
    return camera_.unproject(static_cast<float>(index % width), static_cast<float>(index / width),
                             surface_.smooth_depth_m[index]);
  }

  std::uint32_t nearest_seed(std::uint32_t index) const {
    const int x = static_cast<int>(index) % labels_.width(),
              y = static_cast<int>(index) / labels_.width();
    const Eigen::Vector3f here = point(index);
    float nearest = config_.regrow_m * config_.regrow_m;
    std::uint32_t result = kNoSeed;
    for (int ny = y - 1; ny <= y + 1; ++ny) {
      for (int nx = x - 1; nx <= x + 1; ++nx) {
        if (!seeds_.contains(nx, ny) || seeds_.at(nx, ny) == kNoSeed) continue;
        const std::uint32_t seed = seeds_.at(nx, ny);
        const float distance = (point(seed) - here).squaredNorm();
        if (distance < nearest) nearest = distance, result = seed;
      }
    }
    return result;
  }

  const DepthSurface& surface_;
  const PinholeCamera& camera_;
  const SegmentDepthConfig& config_;
  Image<std::uint32_t>& labels_;
  Image<std::uint32_t> seeds_;
  std::vector<std::uint32_t> open_;
};

/// Drops small components and packs the ids of the others to 16 bits; when there are too many the
/// smallest would not fit, which `min_region_px` of a few pixels rules out for any real image.
DepthRegions pack(const Image<std::uint32_t>& labels, int min_region_px) {
  const std::uint32_t count = labels.empty() ? 0 : *std::max_element(labels.begin(), labels.end());
  std::vector<int> area(count + 1, 0);
  for (std::uint32_t label : labels) ++area[label];
  std::vector<std::uint16_t> id_of(count + 1, 0);
  DepthRegions result{IdImage(labels.width(), labels.height()), {}};
  for (std::uint32_t label = 1; label <= count; ++label) {
    if (area[label] < min_region_px ||
        result.regions.size() == std::numeric_limits<std::uint16_t>::max())
      continue;
    result.regions.push_back({area[label], Eigen::Vector2i::Zero(), Eigen::AlignedBox2i()});
    id_of[label] = static_cast<std::uint16_t>(result.regions.size());
  }
  for (std::size_t i = 0; i < labels.size(); ++i) result.ids[i] = id_of[labels[i]];
  return result;
}

/// Boxes, and for each region the pixel deepest inside it: city-block distance to the nearest pixel
/// of another id, by one pass down and one up (distances only grow within a region).
void describe(DepthRegions& result) {
  const int width = result.ids.width(), height = result.ids.height();
  Image<std::uint16_t> depth(width, height);
  const auto step = [&](int x, int y, int dx, int dy) -> int {
    if (!depth.contains(x + dx, y + dy) || result.ids.at(x + dx, y + dy) != result.ids.at(x, y))
      return 1;
    return depth.at(x + dx, y + dy) + 1;
  };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      if (result.ids.at(x, y))
        depth.at(x, y) = static_cast<std::uint16_t>(std::min(step(x, y, -1, 0), step(x, y, 0, -1)));
  std::vector<int> deepest(result.regions.size(), 0);
  for (int y = height - 1; y >= 0; --y) {
    for (int x = width - 1; x >= 0; --x) {
      const std::uint16_t id = result.ids.at(x, y);
      if (id == 0) continue;
      std::uint16_t& value = depth.at(x, y);
      value =
          static_cast<std::uint16_t>(std::min({int{value}, step(x, y, 1, 0), step(x, y, 0, 1)}));
      DepthRegion& region = result.regions[id - 1u];
      region.extent_px.extend(Eigen::Vector2i(x, y));
      if (value > deepest[id - 1u]) deepest[id - 1u] = value, region.interior_px = {x, y};
    }
  }
}

}  // namespace

void list_fields(SegmentDepthConfig& config, ConfigFields& fields) {
  fields.group("surface", [&](ConfigFields& f) { list_fields(config.surface, f); });
  fields.add("concave_angle_rad", config.concave_angle_rad, 0.f, 3.f,
             "sharpest concave fold inside a region, radians");
  fields.add("concave_sigmas", config.concave_sigmas, 0.f, 100.f,
             "... and in sigmas of the fitted normals");
  fields.add("min_region_px", config.min_region_px, 1, 1000000,
             "smaller regions are dropped, pixels");
  fields.add("regrow_px", config.regrow_px, 0, 100,
             "edge pixels join a region within this many pixels");
  fields.add("regrow_m", config.regrow_m, 0.f, 1.f, "... and within this distance, metres");
}

SegmentDepthConfig reference_segment_depth_config() {
  SegmentDepthConfig config;
  config.surface.discontinuity_sigmas = 0.f;   // the original knows no noise model:
  config.surface.discontinuity_ratio = 0.01f;  // any step over 1 % of the depth is an edge
  config.concave_angle_rad = 0.2455f;          // acos(0.97)
  config.concave_sigmas = 0.f;
  config.min_region_px = 500;
  return config;
}

DepthRegions segment_depth(const DepthImage& depth, const PinholeCamera& camera,
                           const SegmentDepthConfig& config) {
  return segment_depth(fit_depth_surface(depth, camera, config.surface), camera, config);
}

DepthRegions segment_depth(const DepthSurface& surface, const PinholeCamera& camera,
                           const SegmentDepthConfig& config) {
  const Image<std::uint8_t> concave = find_concave_edges(surface, camera, config);
  Image<std::uint32_t> labels = connected_regions(find_interior(surface, concave));
  Regrowth regrowth(surface, camera, config, labels);
  for (int ring = 0; ring < config.regrow_px && regrowth.grow(); ++ring) continue;
  DepthRegions result = pack(labels, config.min_region_px);
  describe(result);
  return result;
}

}  // namespace ovimap
