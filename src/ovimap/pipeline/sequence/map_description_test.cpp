// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/sequence/map_description.h"

#include <gtest/gtest.h>

namespace ovimap {
namespace {

/// Two super-points that are an object each, always shown by one mask together: of the smaller one
/// that mask says little.
class UnsureObject : public ::testing::Test {
 protected:
  UnsureObject() {
    InstanceRegistry::State state;
    for (const Label root : {1u, 2u}) {
      forest_.create();
      SuperPoint& point = state.super_points[root];
      point.votes[++state.last_id] = 20;
      point.seen = FrameRuns({{0, 20}});
      for (int i = 0; i < (root == 1 ? 1000 : 100); ++i)
        extents_[root].add({0.01f * static_cast<float>(i), 0, 0});
      for (std::uint32_t frame = 0; frame < 20; ++frame)
        state.entity_sightings[root].push_back({frame, 7, 250});
    }
    state.aliases[9] = 2;
    registry_.restore(state);
  }

  std::size_t objects_after(const MapEdits& edits) const {
    return summarize_objects(extents_, forest_, registry_, {}, edits).size();
  }

  static MapEdit named(InstanceId id) {
    MapEdit edit;
    edit.id = 1;
    edit.instances = {id};
    edit.name = "vase";
    return edit;
  }

  LabelForest forest_;
  SurfaceExtents extents_;
  InstanceRegistry registry_;
};

TEST_F(UnsureObject, IsLeftOut) {
  EXPECT_EQ(objects_after({}), 1u);
  EXPECT_EQ(objects_after({named(1)}), 1u);
}

TEST_F(UnsureObject, StaysWhereSomebodyCorrectedIt) {
  EXPECT_EQ(objects_after({named(2)}), 2u);
  EXPECT_EQ(objects_after({named(9)}), 2u) << "by an id that it had";
  MapEdit taken_back = named(2), undo;
  taken_back.undone_by = 2;
  undo.action = EditAction::kUndo;
  undo.id = 2;
  undo.undoes = 1;
  EXPECT_EQ(objects_after({taken_back, undo}), 1u);
}

}  // namespace
}  // namespace ovimap
