// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/revise/map_merge.h"

#include "ovimap/io/map_file/map_edits.h"
#include "ovimap/io/map_file/map_file_fixture.h"
#include "ovimap/map/surface/mesh_extraction.h"
#include "ovimap/pipeline/mapping/sessions_fixture.h"

namespace ovimap {
namespace {

/// The same room in two sessions, the second in a frame of its own.
class MapMerging : public MapFolder {
 protected:
  /// Distances of the mesh's vertices to the nearest face of the room, the largest but for 1 %.
  static float roughness(const MapDocument& map) {
    std::vector<Eigen::AlignedBox3f> boxes = {
        {Eigen::Vector3f(-9, -9, -1), Eigen::Vector3f(9, 9, 0)},
        {Eigen::Vector3f(-9, -9, 0), Eigen::Vector3f(-2.2f, 9, 9)},
        {Eigen::Vector3f(-9, 1.8f, 0), Eigen::Vector3f(9, 9, 9)}};
    for (const Furniture& thing : kThings) boxes.push_back(thing.box);
    std::vector<float> distances;
    for (const Eigen::Vector3f& p : extract_mesh(map.map).vertices) {
      float least = 9.f;
      for (const Eigen::AlignedBox3f& box : boxes) {
        const float inside = std::min((p - box.min()).minCoeff(), (box.max() - p).minCoeff());
        least = std::min(least, inside > 0.f ? inside : box.exteriorDistance(p));
      }
      distances.push_back(least);
    }
    std::sort(distances.begin(), distances.end());
    return distances[distances.size() * 99 / 100];
  }

  /// Walls may be found in stretches, boxes may not.
  static bool each_thing_is_one_object(const MapRecord& map) {
    return std::all_of(kThings.begin(), kThings.end(), [&](const Furniture& thing) {
      return 1 == std::count_if(map.instances.begin(), map.instances.end(),
                                [&](const InstanceSummary& instance) {
                                  return thing.box.exteriorDistance(instance.centroid) < 0.05f;
                                });
    });
  }

  static std::string listing(const MapDocument& map, const MapMerge& merged) {
    std::ostringstream text;
    for (const InstanceSummary& i : map.instances)
      text << "#" << i.id << " at " << i.centroid.transpose() << ", " << i.box.sizes().transpose()
           << "\n";
    for (const MergeConflict& c : merged.conflicts)
      text << c.a << " and " << c.b << ": " << c.what << "\n";
    return text.str();
  }

  MapDocument reloaded(const MapDocument& map) const {
    save_map(root_ / "merged.ovimap", map);
    return load_corrected_map(root_ / "merged.ovimap");
  }
};

TEST(MapMerge, DirectionsOfAnotherGridCountFromNothing) {
  const auto seen_in_a_grid_of = [](int rows) {
    MapDocument map;
    map.semantics.views.grid_rows = rows;
    const Label label = map.map.labels().create();
    ObjectView& view = map.semantics.looks[label].views.emplace_back();
    view.super_point = label;
    view.directions.bins = BinSet(map.semantics.views.grid(map.depth_camera).bins());
    view.directions.bins.set(rows);
    map.registry.last_id = 1;
    return map;
  };
  const auto bins_from = [&](int rows) {
    const MapMerge merge =
        merge_maps(seen_in_a_grid_of(24), seen_in_a_grid_of(rows), Pose::Identity(), {});
    return merge.map.semantics.looks.at(2).views.front().directions.bins;
  };
  EXPECT_EQ(bins_from(24).count(), 1);
  EXPECT_TRUE(bins_from(12).empty()) << "they could not be united with those of the first map";
}

TEST_F(MapMerging, TwoSessionsMakeOneMap) {
  const MapDocument a = session(0, 0.55), b = session(0.45, 1, elsewhere());
  const MapMerge merged = merge_maps(session(0, 0.55), b, elsewhere().inverse());
  EXPECT_LT(roughness(merged.map), 0.02f);
  EXPECT_GT(merged.map.map.block_count(), a.map.block_count());
  EXPECT_EQ(merged.map.frames.size(), a.frames.size() + b.frames.size());
  const MapDocument seen = reloaded(merged.map);
  EXPECT_EQ(seen.instances.size(), a.instances.size() + b.instances.size() - merged.pairs.size())
      << listing(seen, merged);
  EXPECT_TRUE(each_thing_is_one_object(seen)) << listing(seen, merged);
  // Under the id of the first map where that had it.
  for (const Furniture& thing : kThings) {
    const Eigen::Vector3f c = thing.box.center();
    const InstanceId id =
        object_at(seen, Pose::Identity(), c.x(), c.y(), thing.box.max().z() * 0.7f);
    const InstanceId before =
        object_at(a, Pose::Identity(), c.x(), c.y(), thing.box.max().z() * 0.7f);
    ASSERT_NE(id, 0u);
    if (before != 0) {
      EXPECT_EQ(id, before);
    }
    EXPECT_GT(fuse_views(appearance_of(seen, id).views, FeatureFusion::kMean).size(), 0);
  }
}

TEST_F(MapMerging, WhatWasJoinedCanBeTakenApart) {
  const MapMerge merged = merge_maps(session(0, 0.55), session(0.45, 1), Pose::Identity());
  ASSERT_FALSE(merged.pairs.empty());
  save_map(root_ / "merged.ovimap", merged.map);
  const std::size_t objects = read_map_info(root_ / "merged.ovimap").instances.size();
  EXPECT_EQ(read_edits(root_ / "merged.ovimap").size(), merged.pairs.size());
  MapEdit undo;
  undo.action = EditAction::kUndo;
  edit_map(root_ / "merged.ovimap", undo);
  EXPECT_EQ(read_map_info(root_ / "merged.ovimap").instances.size(), objects + 1);
}

TEST_F(MapMerging, CorrectionsOfBothMapsLiveOn) {
  MapDocument a = session(0, 0.55), b = session(0.45, 1);
  const auto edit = [](MapDocument& map, EditAction action, InstanceId id,
                       const std::string& name) {
    MapEdit next;
    next.action = action;
    next.instances = {id};
    next.name = name;
    next.id = static_cast<std::int64_t>(map.edits.size()) + 1;
    if (action == EditAction::kLock)
      for (const InstanceSummary& instance : map.instances)
        if (instance.id == id) next.super_points = instance.super_points;
    map.edits.push_back(next);
  };
  const InstanceId red_a = object_at(a, Pose::Identity(), 0.6f, 0.3f, 0.2f),
                   red_b = object_at(b, Pose::Identity(), 0.6f, 0.3f, 0.2f),
                   blue_a = object_at(a, Pose::Identity(), 0.2f, -0.9f, 0.3f),
                   green_b = object_at(b, Pose::Identity(), -1.3f, -0.6f, 0.15f);
  ASSERT_TRUE(red_a != 0 && red_b != 0 && blue_a != 0 && green_b != 0);
  edit(a, EditAction::kRename, red_a, "parcel");
  edit(b, EditAction::kRename, red_b, "box");
  edit(b, EditAction::kRename, green_b, "crate");
  edit(a, EditAction::kLock, blue_a, "");
  const MapMerge merged = merge_maps(std::move(a), b, Pose::Identity());
  const MapDocument seen = reloaded(merged.map);
  EXPECT_EQ(seen.names.at(red_a), "parcel");
  std::set<std::string> names;
  for (const auto& [id, name] : seen.names) names.insert(name);
  EXPECT_TRUE(names.contains("crate"));
  EXPECT_FALSE(names.contains("box"));
  EXPECT_TRUE(seen.locked.contains(blue_a));
  std::string conflicts;
  for (const MergeConflict& conflict : merged.conflicts) conflicts += conflict.what + "\n";
  EXPECT_NE(conflicts.find("one is called 'parcel', the other 'box'"), std::string::npos)
      << conflicts;
  EXPECT_NE(conflicts.find("locked"), std::string::npos) << conflicts;
}

TEST_F(MapMerging, AMergedMapCanBeMergedAgain) {
  MapMerge first = merge_maps(session(0, 0.4), session(0.3, 0.7), Pose::Identity());
  const MapMerge second = merge_maps(std::move(first.map), session(0.6, 1), Pose::Identity());
  EXPECT_TRUE(each_thing_is_one_object(reloaded(second.map)));
}

TEST_F(MapMerging, RefusesEmbeddingsOfDifferentEncoders) {
  MapDocument b = session(0, 0.2);
  b.semantics.encoder.digest = std::string(64, 'f');
  EXPECT_NE(fault_of([&] { merge_maps(session(0, 0.2), b, Pose::Identity()); }).find("reembed"),
            std::string::npos);
}

}  // namespace
}  // namespace ovimap
