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

/// A visit that begins where no keyframe of the map looked from.
class VisitStart : public ::testing::Test {
 protected:
  ObjectPlacing placed_in(const MapDocument& map) const {
    return place_by_objects(map, visit_, positions_,
                            Mapper(furnished_config(), std::make_shared<FurnishedMasks>(room_),
                                   std::make_shared<ColorEncoder>()),
                            PoseFinder(Tracker(TrackConfig{}), LoopConfig{}), AlignmentConfig{});
  }

  static FurnishedRoom seen_in(int frames, double first_turn, double last_turn) {
    FurnishedRoom room = visited(first_turn, last_turn);
    room.frames = frames;
    return room;
  }

  FurnishedRoom room_ = seen_in(40, 0.3, 0.55);
  Unposed visit_{room_};
  std::vector<std::int64_t> positions_ = positions({}, room_.size());
};

TEST_F(VisitStart, TooFewObjectsAreDoubted) {
  const MapDocument home = map_of(seen_in(24, 0, 0.6));
  EXPECT_FALSE(shows_known_place(visit_, positions_, home.map, {}, TrackConfig{}));
  const ObjectPlacing placing = placed_in(home);
  EXPECT_NE(placing.alignment.doubt.find("too few objects say so"), std::string::npos)
      << placing.alignment.doubt;
  EXPECT_TRUE(placing.places.empty());
}

TEST_F(VisitStart, AnotherRoomIsDoubted) {
  FurnishedRoom other;
  other.things = {furniture(1.2f, -0.2f, {0.9f, 0.5f, 0.7f}, {120, 120, 200}),
                  furniture(-0.6f, -1.2f, {0.2f, 0.7f, 0.9f}, {20, 120, 90}),
                  furniture(0.1f, 1.2f, {1.0f, 0.6f, 0.15f}, {80, 20, 120})};
  other.shell.resize(1);
  const ObjectPlacing placing = placed_in(map_of(other));
  EXPECT_NE(placing.alignment.doubt, "");
  EXPECT_TRUE(placing.places.empty());
}

}  // namespace
}  // namespace ovimap
