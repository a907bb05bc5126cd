// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/segment/mask_fusion.h"

#include <algorithm>
#include <map>
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

/// Which segment each (region, entity) pair becomes.
class Assignment {
 public:
  Assignment(const DepthRegions& regions, const Overlaps& overlaps, const MaskFusionConfig& config)
      : config_(config), overlaps_(overlaps) {
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
  bool splits(int count, int entity_area, int region_area) const {
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
      if (splits(count, entity_area_.at(pair.second), region_area)) {
        assign(pair, pair.second);
        rest_area -= count;
      } else if (count > best_count) {
        best_count = count, best_entity = pair.second;
      }
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
  fields.add("adopt_region_share", config.adopt_region_share, 0.f, 1.f,
             "share of a region an entity covers to own its rest");
}

Segments fuse_masks(const DepthRegions& regions, const IdImage& entity_ids, const DepthImage& depth,
                    const MaskFusionConfig& config) {
  const Overlaps overlaps = count_overlaps(regions, entity_ids, depth);
  Assignment assignment(regions, overlaps, config);
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
