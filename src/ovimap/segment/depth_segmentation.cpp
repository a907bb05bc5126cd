// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/segment/depth_segmentation.h"

#include <algorithm>
#include <limits>

#include "ovimap/base/config.h"
#include "ovimap/base/parallel.h"
#include "ovimap/base/vectorize.h"
#include "ovimap/segment/concave_edges.h"
#include "ovimap/segment/connected_regions.h"
#include "ovimap/segment/region_growth.h"
#include "ovimap/segment/task_rows.h"

namespace ovimap {

namespace {

/// The rows that say whether regions grow from the pixels of one row.
struct InteriorRows {
  const std::uint8_t *folds_above, *folds, *folds_below;
  const std::uint8_t *breaks_above, *breaks;
};

OVIMAP_VECTORIZE void mark_interior(const InteriorRows& rows, int width, std::uint8_t* interior) {
  const std::uint8_t *above = rows.folds_above, *here = rows.folds, *below = rows.folds_below;
  const std::uint8_t *breaks = rows.breaks, *breaks_above = rows.breaks_above;
  for (int x = 1; x < width - 1; ++x) {
    const int broken = breaks[x] | (breaks[x - 1] & DepthSurface::kRight) |
                       (breaks_above[x] & DepthSurface::kBelow);
    const int folded = above[x - 1] | above[x] | above[x + 1] | here[x - 1] | here[x] |
                       here[x + 1] | below[x - 1] | below[x] | below[x + 1];
    interior[x] = (broken | folded) == 0;
  }
}

/// Pixels whose surface goes on to all four neighbours and that touch no concave edge: what regions
/// grow from.
Image<std::uint8_t> find_interior(const DepthSurface& surface, const Image<std::uint8_t>& concave) {
  const int width = concave.width(), height = concave.height();
  Image<std::uint8_t> interior(width, height);
  parallel_for(static_cast<std::size_t>(std::max(0, height - 2)), kPixelRowsPerTask,
               [&](std::size_t row) {
                 const int y = static_cast<int>(row) + 1;
                 mark_interior({concave.row(y - 1), concave.row(y), concave.row(y + 1),
                                surface.breaks.row(y - 1), surface.breaks.row(y)},
                               width, interior.row(y));
               });
  return interior;
}

/// Calls `visit(label, begin, end, y)` for every run of equal labels in a row, in raster order.
template <class Visit>
void for_each_run(const Image<std::uint32_t>& labels, const Visit& visit) {
  for (int y = 0; y < labels.height(); ++y) {
    const std::uint32_t* row = labels.row(y);
    for (int begin = 0; begin < labels.width();) {
      int end = begin + 1;
      while (end < labels.width() && row[end] == row[begin]) ++end;
      visit(row[begin], begin, end, y);
      begin = end;
    }
  }
}

/// Drops small components and packs the ids of the others to 16 bits; when there are too many the
/// last do not fit, which `min_region_px` of a few pixels rules out for any real image.
DepthRegions pack(const Image<std::uint32_t>& labels, int min_region_px) {
  std::vector<DepthRegion> components;  // by label
  for_each_run(labels, [&](std::uint32_t label, int begin, int end, int y) {
    if (label >= components.size()) components.resize(label + 1);
    components[label].area_px += end - begin;
    components[label].extent_px.extend(Eigen::Vector2i(begin, y));
    components[label].extent_px.extend(Eigen::Vector2i(end - 1, y));
  });
  std::vector<std::uint16_t> id_of(components.size(), 0);
  DepthRegions result{IdImage::unset(labels.width(), labels.height()), {}};
  for (std::size_t label = 1; label < components.size(); ++label) {
    if (components[label].area_px < min_region_px ||
        result.regions.size() == std::numeric_limits<std::uint16_t>::max())
      continue;
    result.regions.push_back(components[label]);
    id_of[label] = static_cast<std::uint16_t>(result.regions.size());
  }
  parallel_for(labels.size(), kPixelRowsPerTask * 640,
               [&](std::size_t i) { result.ids[i] = id_of[labels[i]]; });
  return result;
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
  grow_regions(surface, camera, config, labels);
  return pack(labels, config.min_region_px);
}

std::vector<Eigen::Vector2i> deepest_pixels(const DepthRegions& regions) {
  const IdImage& ids = regions.ids;
  const int width = ids.width(), height = ids.height();
  Image<std::uint16_t> inset(width, height);
  const auto step = [&](int x, int y, int dx, int dy) -> int {
    if (!inset.contains(x + dx, y + dy) || ids.at(x + dx, y + dy) != ids.at(x, y)) return 1;
    return inset.at(x + dx, y + dy) + 1;
  };
  // City-block distance to the nearest pixel of another id, by one pass down and one up: distances
  // only grow within a region.
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      if (ids.at(x, y))
        inset.at(x, y) = static_cast<std::uint16_t>(std::min(step(x, y, -1, 0), step(x, y, 0, -1)));
  std::vector<int> most(regions.regions.size(), 0);
  std::vector<Eigen::Vector2i> deepest(regions.regions.size(), Eigen::Vector2i::Zero());
  for (int y = height - 1; y >= 0; --y) {
    for (int x = width - 1; x >= 0; --x) {
      const std::uint16_t id = ids.at(x, y);
      if (id == 0) continue;
      const int value = std::min({int{inset.at(x, y)}, step(x, y, 1, 0), step(x, y, 0, 1)});
      inset.at(x, y) = static_cast<std::uint16_t>(value);
      if (value > most[id - 1u]) most[id - 1u] = value, deepest[id - 1u] = {x, y};
    }
  }
  return deepest;
}

}  // namespace ovimap
