// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <filesystem>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "ovimap/base/config.h"
#include "ovimap/base/error_fixture.h"
#include "ovimap/base/temporary_folder_fixture.h"
#include "ovimap/io/map_file/map_file.h"

namespace ovimap {

/// A folder of its own for one test, gone afterwards.
class MapFolder : public ::testing::Test {
 protected:
  std::size_t files_in_root() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(root_), {}));
  }

  const fixture::TemporaryFolder scratch_;
  const std::filesystem::path root_ = scratch_.path();
};

/// Fills a block with random content of which about half the voxels are observed.
inline void fill_randomly(VoxelBlock& block, const LabelForest& forest, std::mt19937& random) {
  const auto below = [&](std::uint32_t limit) {
    return static_cast<std::uint32_t>(random() % limit);
  };
  block.forest_epoch = below(forest.epoch() + 1);
  for (Label label = 1; label <= forest.last_label(); ++label)
    if (below(3) == 0) block.palette.push_back(label);
  for (std::size_t v = 0; v < kBlockVoxels; ++v) {
    if (below(2) == 0) continue;
    block.tsdf[v] = VoxelBlock::stored_distance(static_cast<std::int16_t>(random()));
    block.weight[v] = static_cast<float>(1 + below(100000)) / kWeightSteps;
    FixedColor color;
    for (std::uint16_t& channel : color) channel = static_cast<std::uint16_t>(random());
    block.color[v] = pack_color(color);
    for (std::size_t s = 0; s < kLabelSlots; ++s) {
      const auto position =
          static_cast<std::uint8_t>(below(static_cast<std::uint32_t>(block.palette.size())));
      if (position == 0) continue;
      block.slot(s).label[v] = position;
      block.slot(s).support[v] = static_cast<std::uint16_t>(below(3) == 0 ? 0 : random());
    }
  }
}

/// A map with every kind of content: blocks on both sides of the origin and far away, merged
/// labels.
inline VoxelMap random_map(int block_count, std::uint32_t seed) {
  VoxelMapConfig config;
  config.voxel_size_m = 0.0213f;
  config.truncation_voxels = 4;
  VoxelMap map(config);
  std::mt19937 random(seed);
  for (int i = 0; i < 20; ++i) map.labels().create();
  for (int i = 0; i < 6; ++i)
    map.labels().merge(1 + static_cast<Label>(random() % 20),
                       1 + static_cast<Label>(random() % 20));
  std::vector<BlockIndex> indices = {{-(1 << 20), 0, (1 << 20) - 1}};
  while (static_cast<int>(indices.size()) < block_count)
    indices.emplace_back(static_cast<int>(random() % 12) - 6, static_cast<int>(random() % 12) - 6,
                         static_cast<int>(random() % 12) - 6);
  for (const BlockIndex& index : indices) {
    if (map.find(index) != nullptr) continue;
    VoxelBlock& block = map.writable_block(map.find_or_create(index));
    fill_randomly(block, map.labels(), random);
    if (map.block_count() % 5 != 0) continue;
    block.doubts.resize(kBlockVoxels);
    for (std::size_t v = 0; v < kBlockVoxels; v += 3)
      block.doubts[v] = static_cast<std::uint8_t>(block.weight[v] > 0.f ? v % 7 : 0);
  }
  return map;
}

inline MapDocument random_document(int block_count, std::uint32_t seed) {
  MapDocument document;
  document.map = random_map(block_count, seed);
  document.instance_config.min_vote_share = 0.37f;
  document.instance_config.instances = InstanceReading::kSuperPoints;
  document.instance_config.merging.merge_min_count = 23;
  document.registry.super_points = {
      {1, {7, {{1, 3}, {2, 5}}, FrameRuns({{0, 2}, {5, 6}}), 0, 70}},
      {4, {1, {}, {}, 0, 0}},
      {20, {900, {{3, 800}}, FrameRuns({{3, 803}}), -5, std::int64_t{1} << 40}}};
  document.registry.frames = 900;
  document.registry.aliases = {{2, 1}};
  document.registry.entity_sightings = {{4, {{0, 8}, {3, 65535, 0}}}, {20, {{3, 1, 254}}}};
  document.registry.pair_counts = {{{1, 4}, {11, 2}}, {{4, 20}, {0, 1}}};
  document.registry.last_id = 3;
  InstanceSummary cup, table;
  cup.id = 1;
  cup.box =
      Eigen::AlignedBox3f(Eigen::Vector3f(-0.1f, 0.2f, -0.f), Eigen::Vector3f(0.3f, 0.4f, 1e-20f));
  cup.centroid = {0.1f, 0.3f, 1.f / 3.f};
  cup.points = 5000000000;
  cup.views = 3;
  cup.super_points = {1, 4};
  cup.confidence = 2.f / 3.f;
  table.id = 3;
  table.views = 800;
  document.instances = {cup, table};
  ObjectPart handle = cup;
  handle.id = 4;
  handle.super_points = {4};
  handle.confidence.reset();
  handle.views = 4;
  document.parts = {handle};
  document.names = {{1, "Tasse \xc3\xa4 'x' \"y\""}, {2, ""}};
  document.semantics.encoder = {"colours", 3, std::string(64, 'a')};
  document.semantics.views.theta_novel = 0.21f;
  document.semantics.crops.kept_views = 7;
  document.depth_camera = {640, 480, 585.1f, 585.2f, 319.5f, 239.25f};
  SuperPointLook& look = document.semantics.looks[1];
  look.seen_in_world = cup.box;
  look.offered = 12;
  look.queries = 3;
  look.views.resize(2);
  look.views[0] = {5, 900, Eigen::Vector3f(0, 0.6f, -0.8f), {{1, 2}, {3}, {}}, 1, {}};
  look.views[0].crop.object_px = {Eigen::Vector2i(0, 1), Eigen::Vector2i(2, 3)};
  look.views[0].writing = {{"EXIT \xC3\xA9", 0.75f, {Eigen::Vector2i(0, 1), Eigen::Vector2i(2, 2)}},
                           {"2", 1.f, {Eigen::Vector2i(1, 1), Eigen::Vector2i(1, 1)}}};
  document.semantics.writing_reader = "reader";
  look.views[0].things = Eigen::Vector3f(2.5f, -1, 0);
  document.semantics.recognizer = {"detector", {"cup|mug", "chair", "television"}};
  ViewDirections& directions = look.views[0].directions;
  directions.center_in_world = {1.f / 3, 2, -3};
  directions.bins = BinSet(document.semantics.views.grid(document.depth_camera).bins());
  for (const int bin : {0, 77, 767}) directions.bins.set(bin);
  look.views[1].frame = std::int64_t{1} << 40;
  look.views[1].super_point = 1;
  // Of an object too small to be listed.
  document.semantics.looks[document.map.labels().root(20)].queries = 1;
  document.up = {0.f, -1.f, 0.f};
  document.surfaces[1] = {{-0.1f, 0.2f, 0.f},
                          {0.3f, 0.4f, 0.1f}};  // its box's corners: kept exactly
  document.kept_frames[0] =
      std::make_shared<KeptFrame>(KeptFrame{{9, 0, 255}, {1}, {}, {0, 20, 3}});
  document.config_text = "map.voxel_size_m: 0.0213\nrun.name: \"a: b\"\n";
  document.timings = "integrate 12.500 40.000 3\n";
  document.source = "/data/some where";
  document.mask_frames = 2;
  document.version = "0.1.0";
  for (int i = 0; i < 3; ++i) {
    Pose pose(Eigen::AngleAxisd(0.1 + i, Eigen::Vector3d(1, 2, 3).normalized()));
    pose.translation() = Eigen::Vector3d(1.0 / 3, -0.0, i);
    document.frames.push_back({i * 5, 0.1 * i, "frame-" + std::to_string(i), pose, i % 2 == 0});
  }
  const Eigen::AlignedBox3f here(Eigen::Vector3f(0.1f, 0.2f, 0.3f), Eigen::Vector3f(1, 2, 3)),
      there(Eigen::Vector3f(-1, 0, 0.25f), Eigen::Vector3f(-0.5f, 1, 0.5f));
  document.history.visits = {{"/data/evening", 0, 0}, {"/data/morning", 2, 6, 1.7e9}};
  document.history.events = {{1, ObjectEventKind::kMoved, 2, 2, here, there, 0},
                             {2, ObjectEventKind::kGone, 2, 2, here, {}, 0},
                             {3, ObjectEventKind::kAppeared, 2, 2, {}, there, 2}};
  PastObject was{{0.5f, 1.f / 3, -2}, 70, 5, {1, 4}, {here.min(), here.max()}, {{9, 0, 255}, {}}};
  for (Label& label : was.super_points) label = document.map.labels().root(label);
  document.history.events[1].was = std::make_shared<const PastObject>(was);
  SeenFree::Regions regions;
  regions[pack_index({-3, 0, 2})][17] = {255, 44};
  regions[pack_index({4, 1, -1})][511] = {3, 0};
  document.seen_free.restore(regions);
  document.seen_free.suspect({-20, 3, 17});
  document.movers = {{1, {0.5f, 0.4f, 1.7f}, {{0, {0.1f, -2, 1}}, {5, {0.3f, -2, 1}}}},
                     {2, {0.1f, 0.1f, 0.1f}, {{std::int64_t{1} << 40, {1.f / 3, 0, 0}}}}};
  using Kind = LiveStep::Kind;
  document.live_steps = {{Kind::kFrame, 0, true, false},
                         {Kind::kMasks, 0},
                         {Kind::kResumed},
                         {Kind::kFrame, std::int64_t{1} << 40, false, true},
                         {Kind::kMoved}};
  return document;
}

inline std::string dump_of(VoxelMapConfig map, InstanceConfig instance) {
  ConfigFields fields;
  list_fields(map, fields);
  list_fields(instance, fields);
  return fields.dump();
}

inline bool same_block(const VoxelBlock& a, const VoxelBlock& b) {
  return a.index == b.index && a.forest_epoch == b.forest_epoch && a.palette == b.palette &&
         a.tsdf == b.tsdf && a.weight == b.weight && a.color == b.color && a.slots == b.slots &&
         a.doubted() == b.doubted() && (!a.doubted() || a.doubts == b.doubts);
}

inline bool same_voxels(const VoxelMap& a, const VoxelMap& b) {
  const std::vector<std::uint32_t> in_a = a.ordered_slots(), in_b = b.ordered_slots();
  return std::equal(
      in_a.begin(), in_a.end(), in_b.begin(), in_b.end(),
      [&](std::uint32_t i, std::uint32_t j) { return same_block(a.block(i), b.block(j)); });
}

inline bool same_instance(const InstanceSummary& a, const InstanceSummary& b) {
  return a.id == b.id && a.box.min() == b.box.min() && a.box.max() == b.box.max() &&
         a.centroid == b.centroid && a.points == b.points && a.views == b.views &&
         a.super_points == b.super_points && a.confidence == b.confidence;
}

inline bool same_instances(const std::vector<InstanceSummary>& a,
                           const std::vector<InstanceSummary>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), same_instance);
}

inline bool same_frame(const FrameLogEntry& a, const FrameLogEntry& b) {
  return a.index == b.index && a.timestamp_s == b.timestamp_s && a.name == b.name &&
         a.labelled == b.labelled && a.world_from_camera.matrix() == b.world_from_camera.matrix();
}

inline bool same_registry(const InstanceRegistry::State& a, const InstanceRegistry::State& b) {
  const auto same_point = [](const auto& x, const auto& y) {
    return x.first == y.first && x.second.frames_seen == y.second.frames_seen &&
           x.second.votes == y.second.votes && x.second.seen == y.second.seen &&
           x.second.first_frame == y.second.first_frame &&
           x.second.last_frame == y.second.last_frame;
  };
  return std::equal(a.super_points.begin(), a.super_points.end(), b.super_points.begin(),
                    b.super_points.end(), same_point) &&
         a.frames == b.frames && a.aliases == b.aliases && a.pair_counts == b.pair_counts &&
         a.entity_sightings == b.entity_sightings && a.last_id == b.last_id;
}

inline bool same_view(const ObjectView& a, const ObjectView& b) {
  return a.frame == b.frame && a.visible_px == b.visible_px && a.embedding == b.embedding &&
         a.super_point == b.super_point && a.things == b.things &&
         a.directions.bins == b.directions.bins &&
         a.directions.center_in_world == b.directions.center_in_world &&
         a.crop.image_jpeg == b.crop.image_jpeg && a.crop.mask_png == b.crop.mask_png &&
         (a.crop.empty() || (a.crop.object_px.min() == b.crop.object_px.min() &&
                             a.crop.object_px.max() == b.crop.object_px.max())) &&
         std::equal(a.writing.begin(), a.writing.end(), b.writing.begin(), b.writing.end(),
                    [](const WrittenLine& x, const WrittenLine& y) {
                      return x.text == y.text && x.confidence == y.confidence &&
                             x.box_px.min() == y.box_px.min() && x.box_px.max() == y.box_px.max();
                    });
}

inline bool same_look(const SuperPointLook& a, const SuperPointLook& b) {
  return a.seen_in_world.min() == b.seen_in_world.min() &&
         a.seen_in_world.max() == b.seen_in_world.max() && a.offered == b.offered &&
         a.queries == b.queries &&
         std::equal(a.views.begin(), a.views.end(), b.views.begin(), b.views.end(), same_view);
}

inline bool same_semantics(const SemanticRecord& a, const SemanticRecord& b) {
  const auto same_entry = [](const auto& x, const auto& y) {
    return x.first == y.first && same_look(x.second, y.second);
  };
  return a.encoder == b.encoder && a.recognizer == b.recognizer &&
         a.views.theta_novel == b.views.theta_novel && a.crops.kept_views == b.crops.kept_views &&
         std::equal(a.looks.begin(), a.looks.end(), b.looks.begin(), b.looks.end(), same_entry);
}

inline bool same_kept_frame(const KeptFrames::value_type& a, const KeptFrames::value_type& b) {
  return a.first == b.first && a.second->depth_png == b.second->depth_png &&
         a.second->color_jpeg == b.second->color_jpeg &&
         a.second->segments_png == b.second->segments_png && a.second->labels == b.second->labels;
}

inline bool same_box(const Eigen::AlignedBox3f& a, const Eigen::AlignedBox3f& b) {
  return a.isEmpty() ? b.isEmpty() : a.min() == b.min() && a.max() == b.max();
}

inline bool same_past(const PastObject& a, const PastObject& b) {
  return a.centroid == b.centroid && a.points == b.points && a.views == b.views &&
         a.super_points == b.super_points && a.surface == b.surface && a.colors == b.colors;
}

inline bool same_event(const ObjectEvent& a, const ObjectEvent& b) {
  if ((a.was == nullptr) != (b.was == nullptr)) return false;
  if (a.was && !same_past(*a.was, *b.was)) return false;
  return a.instance == b.instance && a.kind == b.kind && a.visit == b.visit && a.frame == b.frame &&
         a.may_be == b.may_be && same_box(a.before, b.before) && same_box(a.after, b.after);
}

/// What two documents differ in; empty when in nothing.
inline std::string difference(const MapDocument& a, const MapDocument& b) {
  if (!same_voxels(a.map, b.map)) return "voxels";
  if (a.map.labels().roots() != b.map.labels().roots() ||
      a.map.labels().epoch() != b.map.labels().epoch())
    return "labels";
  if (dump_of(a.map.config(), a.instance_config) != dump_of(b.map.config(), b.instance_config))
    return "configs";
  if (!same_registry(a.registry, b.registry)) return "registry";
  if (!same_instances(a.instances, b.instances)) return "instances";
  if (!same_instances(a.parts, b.parts)) return "parts";
  if (a.names != b.names) return "names";
  if (a.up != b.up || a.surfaces != b.surfaces) return "geometry";
  if (!same_semantics(a.semantics, b.semantics)) return "semantics";
  if (!std::equal(a.frames.begin(), a.frames.end(), b.frames.begin(), b.frames.end(), same_frame))
    return "frames";
  if (!std::equal(a.kept_frames.begin(), a.kept_frames.end(), b.kept_frames.begin(),
                  b.kept_frames.end(), same_kept_frame))
    return "kept frames";
  if (a.history.visits != b.history.visits ||
      !std::equal(a.history.events.begin(), a.history.events.end(), b.history.events.begin(),
                  b.history.events.end(), same_event))
    return "history";
  if (a.seen_free.regions() != b.seen_free.regions() || a.movers != b.movers) return "motion";
  if (a.live_steps != b.live_steps) return "live steps";
  if (a.depth_camera != b.depth_camera) return "camera";
  if (a.config_text != b.config_text || a.timings != b.timings || a.source != b.source ||
      a.version != b.version)
    return "texts";
  return a.mask_frames == b.mask_frames ? "" : "mask frames";
}

}  // namespace ovimap
