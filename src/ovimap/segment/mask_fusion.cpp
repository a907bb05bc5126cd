// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/segment/mask_fusion.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "ovimap/base/config.h"

namespace ovimap {

namespace {

using RegionEntity = std::pair<std::uint16_t, std::uint16_t>;

/// Pixels per (region, entity) pair; region 0 holds valid depth outside every region.
using Overlaps = std::map<RegionEntity, int>;

Overlaps count_overlaps(const DepthRegions& regions, const IdImage& entity_ids,
                        const DepthImage& depth) {
  Overlaps overlaps;
  for (std::size_t i = 0; i < depth.size();) {  // runs of equal pairs cost one look-up
    const RegionEntity pair{regions.ids[i], entity_ids[i]};
    int count = 0;
    for (; i < depth.size() && regions.ids[i] == pair.first && entity_ids[i] == pair.second; ++i)
      count += depth[i] > 0.f;
    if (count > 0) overlaps[pair] += count;
  }
  return overlaps;
}

/// The pairs that hold a square of `side_px`. The largest square that ends at a pixel is one larger
/// than the least of those that end at its three neighbours above and to the left.
std::set<RegionEntity> pairs_with_core(const DepthRegions& regions, const IdImage& entity_ids,
                                       int side_px) {
  const int width = entity_ids.width(), height = entity_ids.height();
  std::set<RegionEntity> found;
  if (side_px > std::min(width, height)) return found;
  std::vector<int> above(static_cast<std::size_t>(width) + 1, 0), row(above);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const auto i = static_cast<std::size_t>(x);
      const RegionEntity pair{regions.ids.at(x, y), entity_ids.at(x, y)};
      row[i + 1] = 0;
      if (pair.first == 0 || pair.second == 0) continue;
      const auto same = [&](int dx, int dy) {
        return x >= dx && y >= dy && regions.ids.at(x - dx, y - dy) == pair.first &&
               entity_ids.at(x - dx, y - dy) == pair.second;
      };
      const bool inner = same(1, 0) && same(0, 1) && same(1, 1);
      row[i + 1] = inner ? 1 + std::min({row[i], above[i + 1], above[i]}) : 1;
      if (row[i + 1] == side_px) found.insert(pair);
    }
    std::swap(above, row);
  }
  return found;
}

/// Which segment each (region, entity) pair becomes.
class Assignment {
 public:
  Assignment(const DepthRegions& regions, const Overlaps& overlaps,
             const std::set<RegionEntity>& cores, const MaskFusionConfig& config)
      : config_(config), overlaps_(overlaps), cores_(cores) {
    for (const auto& [pair, count] : overlaps) entity_area_[pair.second] += count;
    for (std::size_t i = 0; i < regions.regions.size(); ++i)
      if (regions.regions[i].area_px >= config.min_region_px)
        assign_region(static_cast<std::uint16_t>(i + 1), regions.regions[i].area_px);
    for (auto found = overlaps.begin(); found != overlaps.end() && found->first.first == 0; ++found)
      if (found->first.second != 0 && found->second >= config.min_entity_px)
        assign(found->first, found->first.second);
  }

  std::uint16_t segment_of(const RegionEntity& pair) const {
    const auto found = segment_of_.find(pair);
    return found == segment_of_.end() ? 0 : found->second;
  }
  std::vector<Segment> segments;

 private:
  bool lies_within(int count, int entity_area, int region_area) const {
    return static_cast<float>(count) >
               config_.split_entity_share * static_cast<float>(entity_area) &&
           static_cast<float>(count) < config_.split_region_share * static_cast<float>(region_area);
  }

  void assign_region(std::uint16_t region, int region_area) {
    const auto begin = overlaps_.lower_bound({region, 0});
    const auto end = overlaps_.lower_bound({static_cast<std::uint16_t>(region + 1), 0});
    int rest_area = region_area, best_count = 0;
    std::uint16_t best_entity = 0;
    for (auto found = begin; found != end && found->first.first == region; ++found) {
      const auto& [pair, count] = *found;
      if (pair.second == 0) continue;
      if (lies_within(count, entity_area_.at(pair.second), region_area)) {
        assign(pair, pair.second);
        rest_area -= count;
      } else if (count > best_count) {
        best_count = count, best_entity = pair.second;
      }
    }
    for (auto found = begin; found != end && found->first.first == region; ++found) {
      const auto& [pair, count] = *found;
      if (pair.second == best_entity || segment_of_.contains(pair) || !cores_.contains(pair))
        continue;
      assign(pair, pair.second);
      rest_area -= count;
    }
    if (static_cast<float>(best_count) < config_.adopt_region_share * static_cast<float>(rest_area))
      best_entity = 0;
    add_rest(region, best_entity, begin, end);
  }

  /// Everything of the region that was not split off becomes one segment.
  void add_rest(std::uint16_t region, std::uint16_t entity, Overlaps::const_iterator begin,
                Overlaps::const_iterator end) {
    std::uint16_t id = 0;
    for (auto found = begin; found != end && found->first.first == region; ++found) {
      if (segment_of_.contains(found->first)) continue;
      if (id == 0) id = new_segment(entity);
      segment_of_[found->first] = id;
    }
  }

  void assign(const RegionEntity& pair, std::uint16_t entity) {
    segment_of_[pair] = new_segment(entity);
  }

  std::uint16_t new_segment(std::uint16_t entity) {
    segments.push_back({entity, 0});
    return static_cast<std::uint16_t>(segments.size());
  }

  const MaskFusionConfig& config_;
  const Overlaps& overlaps_;
  const std::set<RegionEntity>& cores_;
  std::map<std::uint16_t, int> entity_area_;
  std::map<RegionEntity, std::uint16_t> segment_of_;
};

}  // namespace

void list_fields(MaskFusionConfig& config, ConfigFields& fields) {
  fields.add("min_region_px", config.min_region_px, 1, 1000000,
             "smaller geometric regions take no part, pixels");
  fields.add("min_entity_px", config.min_entity_px, 1, 100000000,
             "least depth pixels of an entity outside all regions (100000000: none has so many, as "
             "in the paper's code)");
  fields.add("split_entity_share", config.split_entity_share, 0.f, 1.f,
             "share of an entity inside a region to split it off");
  fields.add("split_region_share", config.split_region_share, 0.f, 1.f,
             "largest share of the region that is split off");
  fields.add("split_core_px", config.split_core_px, 1, 100000000,
             "side of a square that an entity's part of a region holds, to split it off whatever "
             "its share, pixels (100000000: never, as in the paper's code)");
  fields.add("adopt_region_share", config.adopt_region_share, 0.f, 1.f,
             "share of a region an entity covers to own its rest");
}

Segments fuse_masks(const DepthRegions& regions, const IdImage& entity_ids, const DepthImage& depth,
                    const MaskFusionConfig& config) {
  const Overlaps overlaps = count_overlaps(regions, entity_ids, depth);
  const std::set<RegionEntity> cores = pairs_with_core(regions, entity_ids, config.split_core_px);
  Assignment assignment(regions, overlaps, cores, config);
  Segments result{IdImage(depth.width(), depth.height()), std::move(assignment.segments)};
  for (std::size_t i = 0; i < depth.size();) {
    const RegionEntity pair{regions.ids[i], entity_ids[i]};
    const std::uint16_t segment = assignment.segment_of(pair);
    for (; i < depth.size() && regions.ids[i] == pair.first && entity_ids[i] == pair.second; ++i) {
      if (segment == 0 || depth[i] <= 0.f) continue;
      result.ids[i] = segment;
      ++result.segments[segment - 1u].area_px;
    }
  }
  return result;
}

Segments segments_of_regions(const DepthRegions& regions) {
  Segments result{regions.ids, {}};
  for (const DepthRegion& region : regions.regions) result.segments.push_back({0, region.area_px});
  return result;
}

}  // namespace ovimap
