// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/corrections/map_corrections.h"

#include <gtest/gtest.h>

#include "ovimap/io/corrections/map_edit_log.h"

namespace ovimap {
namespace {

using Ids = std::vector<InstanceId>;

MapEdit edit(EditAction action, Ids instances) {
  MapEdit result;
  result.action = action;
  result.instances = std::move(instances);
  return result;
}
MapEdit rename(InstanceId id, const std::string& name) {
  MapEdit result = edit(EditAction::kRename, {id});
  result.name = name;
  return result;
}
MapEdit split(InstanceId id, std::vector<Label> leaving, InstanceId new_id) {
  MapEdit result = edit(EditAction::kSplit, {id});
  result.super_points = std::move(leaving);
  result.new_instance = new_id;
  return result;
}
MapEdit lock(InstanceId id, std::vector<Label> kept) {
  MapEdit result = edit(EditAction::kLock, {id});
  result.super_points = std::move(kept);
  return result;
}
MapEdit undo(std::int64_t id) {
  MapEdit result = edit(EditAction::kUndo, {});
  result.undoes = id;
  return result;
}

/// Objects 1 (super-points 1, 2), 3 (super-point 4) and 7 (5, 6), each super-point a block with one
/// layer of surface at its label's place along x.
class MapCorrections : public ::testing::Test {
 protected:
  MapCorrections() {
    for (Label label = 1; label <= 6; ++label) {
      map_.labels().create();
      VoxelBlock& block = map_.writable_block(map_.find_or_create({static_cast<int>(label), 0, 0}));
      block.palette = {0, label};
      for (std::size_t v = 0; v < 64; ++v) {
        block.weight[v] = 1.f;
        block.slot(0).label[v] = 1;
        block.slot(0).support[v] = 2;
      }
    }
    for (const auto& [id, labels] :
         std::map<InstanceId, std::vector<Label>>{{1, {1, 2}}, {3, {4}}, {7, {5, 6}}}) {
      InstanceSummary& instance = record_.instances.emplace_back();
      instance.id = id;
      instance.super_points = labels;
      instance.views = static_cast<int>(id);
      instance.confidence = 0.1f * static_cast<float>(id);
      record_.surfaces[id] = {{static_cast<float>(id), 0, 0}};
      for (const Label label : labels) {
        record_.registry.super_points[label] = {3, {{label + 10, 3}}, FrameRuns({{0, label}})};
        SuperPointLook& look = record_.semantics.looks[label];
        look.views.resize(1);
        look.views[0].frame = id;
        look.views[0].super_point = label;
      }
    }
    measure_instances(map_, record_.instances);
    record_.names = {{3, "cup"}};
    record_.registry.aliases = {{2, 1}};
    record_.registry.last_id = 16;
  }

  void log(MapEdit next) {
    next.id = static_cast<std::int64_t>(record_.edits.size()) + 1;
    record_.edits.push_back(std::move(next));
  }

  MapRecord corrected() {
    MapRecord result = record_;
    aliases_ = apply_edits(result, map_.labels(), [&]() -> const VoxelMap& {
      ++asked_;
      return map_;
    });
    return result;
  }

  static std::map<InstanceId, std::vector<Label>> parts(const std::vector<InstanceSummary>& list) {
    std::map<InstanceId, std::vector<Label>> result;
    for (const InstanceSummary& instance : list) result[instance.id] = instance.super_points;
    return result;
  }
  using Parts = std::map<InstanceId, std::vector<Label>>;

  VoxelMap map_;
  MapRecord record_;
  InstanceAliases aliases_;
  int asked_ = 0;  // for the voxels
};

TEST_F(MapCorrections, WithoutEditsNothingChanges) {
  const MapRecord same = corrected();
  EXPECT_EQ(parts(same.instances), parts(record_.instances));
  EXPECT_EQ(same.names, record_.names);
  EXPECT_EQ(aliases_, record_.registry.aliases);
}

TEST_F(MapCorrections, ANameIsGivenAndTakenAway) {
  log(rename(1, "table"));
  log(rename(3, ""));
  EXPECT_EQ(corrected().names, (std::map<InstanceId, std::string>{{1, "table"}}));
  log(rename(2, "desk"));  // an old id of 1
  EXPECT_EQ(corrected().names.at(1), "desk");
  EXPECT_EQ(asked_, 0);
}

TEST_F(MapCorrections, MergedObjectsAreOneWithEverythingTheyHad) {
  log(edit(EditAction::kMerge, {7, 3, 1}));
  const MapRecord one = corrected();
  ASSERT_EQ(parts(one.instances), (Parts{{7, {1, 2, 4, 5, 6}}}));
  InstanceSummary measured;
  measured.super_points = {1, 2, 4, 5, 6};
  std::vector<InstanceSummary> direct = {measured};
  measure_instances(map_, direct);
  const InstanceSummary& merged = one.instances[0];
  EXPECT_EQ(merged.points, direct[0].points);
  EXPECT_TRUE(merged.box.isApprox(direct[0].box));
  EXPECT_TRUE(merged.centroid.isApprox(direct[0].centroid, 1e-5f));
  EXPECT_EQ(merged.views, 7);
  EXPECT_FALSE(merged.confidence.has_value());
  EXPECT_EQ(one.names.at(7), "cup");
  EXPECT_EQ(one.surfaces.at(7).size(), 3u);
  EXPECT_EQ(appearance_of(one, 7).views.size(), 5u);
  EXPECT_EQ(aliases_.at(1), 7u);
  EXPECT_EQ(asked_, 0);  // none of it needs the voxels
}

TEST_F(MapCorrections, APartBecomesAnObject) {
  log(split(7, {6}, 17));
  log(rename(17, "lid"));
  const MapRecord two = corrected();
  EXPECT_EQ(parts(two.instances), (Parts{{1, {1, 2}}, {3, {4}}, {7, {5}}, {17, {6}}}));
  EXPECT_EQ(two.names.at(17), "lid");
  std::vector<InstanceSummary> lid(1);
  lid[0].super_points = {6};
  measure_instances(map_, lid);
  EXPECT_EQ(two.instances[3].points, lid[0].points);
  EXPECT_TRUE(two.instances[3].box.isApprox(lid[0].box));
  EXPECT_EQ(two.instances[2].views, 5);  // those of the super-points that each has
  EXPECT_EQ(two.instances[3].views, 6);
  EXPECT_EQ(asked_, 1);
  EXPECT_EQ(two.instances[0].confidence, 0.1f);  // left alone
  EXPECT_FALSE(two.instances[2].confidence.has_value());
  EXPECT_FALSE(two.instances[3].confidence.has_value());
}

TEST_F(MapCorrections, APartTakesItsViewsAlong) {
  log(split(7, {6}, 17));
  const MapRecord two = corrected();
  for (const auto& [id, label] : std::map<InstanceId, Label>{{7, 5}, {17, 6}}) {
    const Appearance look = appearance_of(two, id);
    ASSERT_EQ(look.views.size(), 1u);
    EXPECT_EQ(look.views[0]->super_point, label);
  }
  log(undo(1));
  EXPECT_EQ(appearance_of(corrected(), 7).views.size(), 2u);
}

TEST_F(MapCorrections, ASplitOfEverythingIsNone) {
  log(split(7, {6}, 17));
  map_.labels().merge(5, 6);  // mapping found later that they are one
  record_.instances[2].super_points = {5};
  EXPECT_EQ(parts(corrected().instances), (Parts{{1, {1, 2}}, {3, {4}}, {7, {5}}}));
}

TEST_F(MapCorrections, ALockedObjectStaysAsItWas) {
  log(lock(1, {1, 2}));
  // Mapping goes on: 1 gets 4 as well, and loses 2 to 7.
  record_.instances[0].super_points = {1, 4};
  record_.instances.erase(record_.instances.begin() + 1);
  record_.instances[1].super_points = {2, 5, 6};
  const MapRecord kept = corrected();
  EXPECT_EQ(parts(kept.instances), (Parts{{1, {1, 2}}, {7, {5, 6}}, {14, {4}}}));
  EXPECT_TRUE(kept.locked.contains(1));
}

TEST_F(MapCorrections, ALockedObjectOutlivesItsAlias) {
  log(lock(7, {5, 6}));
  record_.registry.aliases[7] = 1;  // mapping took it for a part of 1
  record_.instances[0].super_points = {1, 2, 5, 6};
  record_.instances.pop_back();
  EXPECT_EQ(parts(corrected().instances), (Parts{{1, {1, 2}}, {3, {4}}, {7, {5, 6}}}));
}

TEST_F(MapCorrections, DeletedIsGoneAndHiddenIsKeptApart) {
  log(edit(EditAction::kDelete, {1}));
  log(edit(EditAction::kHide, {3}));
  const MapRecord rest = corrected();
  EXPECT_EQ(parts(rest.instances), (Parts{{7, {5, 6}}}));
  EXPECT_EQ(parts(rest.hidden), (Parts{{3, {4}}}));
  EXPECT_TRUE(appearance_of(rest, 1).views.empty());
  EXPECT_EQ(appearance_of(rest, 3).views.size(), 1u) << "hidden, but known";
}

TEST_F(MapCorrections, UndoingAnUndoBringsBack) {
  log(edit(EditAction::kDelete, {1}));
  log(undo(1));
  EXPECT_EQ(corrected().instances.size(), 3u);
  log(undo(2));
  EXPECT_EQ(corrected().instances.size(), 2u);
  MapEdits marked = record_.edits;
  mark_undone(marked);
  EXPECT_EQ(marked[0].undone_by, 0);
  EXPECT_EQ(marked[1].undone_by, 3);
}

TEST_F(MapCorrections, EditsOfWhatIsNoLongerThereDoNothing) {
  log(edit(EditAction::kMerge, {3, 99}));
  log(edit(EditAction::kDelete, {98}));
  log(split(97, {4}, 18));
  EXPECT_EQ(parts(corrected().instances), parts(record_.instances));
}

TEST_F(MapCorrections, WhatIsJoinedThroughALostObjectIsJoined) {
  log(edit(EditAction::kMerge, {98, 3}));  // 98 has lost its surface since
  log(edit(EditAction::kMerge, {1, 98}));
  const MapRecord one = corrected();
  EXPECT_EQ(parts(one.instances), (Parts{{1, {1, 2, 4}}, {7, {5, 6}}}));
  EXPECT_EQ(one.names.at(1), "cup");
  EXPECT_EQ(appearance_of(one, 1).views.size(), 3u);
}

TEST_F(MapCorrections, ObjectsWithoutSuperPointsCanBeCorrected) {
  for (InstanceSummary& instance : record_.instances) instance.super_points.clear();
  log(edit(EditAction::kMerge, {1, 3}));
  log(edit(EditAction::kHide, {7}));
  const MapRecord rest = corrected();
  EXPECT_EQ(parts(rest.instances), (Parts{{1, {}}}));
  EXPECT_EQ(rest.hidden.size(), 1u);
}

}  // namespace
}  // namespace ovimap
