// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/sequence/visit_start.h"

#include <gtest/gtest.h>

#include "ovimap/pipeline/mapping/sessions_fixture.h"

namespace ovimap {
namespace {

/// A room's frames without their poses.
class Unposed : public FrameSource {
 public:
  explicit Unposed(const FurnishedRoom& room) : room_(room) {}
  std::string kind() const override { return room_.kind(); }
  std::int64_t size() const override { return room_.size(); }
  bool posed() const override { return false; }
  FrameRead read(std::int64_t position) const override {
    FrameRead read = room_.read(position);
    read.frame->posed = false;
    read.frame->world_from_camera = Pose::Identity();
    return read;
  }

 private:
  const FurnishedRoom& room_;
};

/// A visit that begins where no camera of the map stood.
class VisitStart : public ::testing::Test {
 protected:
  ObjectPlacing placed_in(const MapDocument& map) const {
    PoseFinder finder(Tracker(TrackConfig{}), LoopConfig{});
    return place_by_objects(map, visit_, positions_,
                            Mapper(furnished_config(), std::make_shared<FurnishedMasks>(room_),
                                   std::make_shared<ColorEncoder>()),
                            &finder, AlignmentConfig{});
  }
  static FurnishedRoom seen_in(int frames, double first_turn, double last_turn) {
    FurnishedRoom room = visited(first_turn, last_turn);
    room.frames = frames;
    return room;
  }
  Pose error_of(const Pose& world_from_camera, std::int64_t position) const {
    return room_.read(position).frame->world_from_camera.inverse() * world_from_camera;
  }

  FurnishedRoom room_ = seen_in(40, 0.6, 0.85);
  Unposed visit_{room_};
  std::vector<std::int64_t> positions_ = positions({}, room_.size());
};

TEST_F(VisitStart, ObjectsTellWhereNoKeyframeDoes) {
  const MapDocument home = map_of(seen_in(24, 0.9, 1.5));
  EXPECT_FALSE(shows_known_place(visit_, positions_, home.map, {}, TrackConfig{}));
  const ObjectPlacing placing = placed_in(home);
  EXPECT_EQ(placing.alignment.doubt, "");
  ASSERT_FALSE(placing.places.empty());
  for (const Keyframe& place : placing.places) {
    const Pose error = error_of(place.world_from_camera, place.index);
    EXPECT_LT(error.translation().norm(), 0.06) << place.index;
    EXPECT_LT(Eigen::AngleAxisd(error.linear()).angle(), 0.02) << place.index;
  }
  Tracker tracker(TrackConfig{});
  tracker.begin_in({});
  tracker.propose(placing.places);
  const TrackedFrame& first = tracker.track(*visit_.read(0).frame, home.map);
  ASSERT_TRUE(first.tracked);
  EXPECT_LT(error_of(first.world_from_camera, 0).translation().norm(), 0.02);
}

/// Before bare floor and boxes, no wall in sight, the camera slides by metres: its map is bent.
TEST_F(VisitStart, ABentMapIsDoubted) {
  room_ = seen_in(40, 0.3, 0.55);
  const ObjectPlacing placing = placed_in(map_of(seen_in(24, 0, 0.6)));
  EXPECT_NE(placing.alignment.doubt, "");
  EXPECT_TRUE(placing.places.empty());
}

TEST_F(VisitStart, AnotherRoomIsDoubted) {
  FurnishedRoom other;
  other.things = {furniture(1.2f, -0.2f, {0.9f, 0.5f, 0.7f}, {120, 120, 200}),
                  furniture(-0.6f, -1.2f, {0.2f, 0.7f, 0.9f}, {20, 120, 90}),
                  furniture(0.1f, 1.2f, {1.0f, 0.6f, 0.15f}, {80, 20, 120})};
  const ObjectPlacing placing = placed_in(map_of(other));
  EXPECT_NE(placing.alignment.doubt, "");
  EXPECT_TRUE(placing.places.empty());
}

}  // namespace
}  // namespace ovimap
