// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/sequence/pose_finder.h"

#include <gtest/gtest.h>

#include "ovimap/pipeline/sequence/last_loops.h"
#include "ovimap/pipeline/sequence/sequence_run.h"
#include "ovimap/track/room_camera_fixture.h"

namespace ovimap {
namespace {

/// Once round in the room, looking outwards, and on for a while.
class RoundInARoom : public FrameSource {
 public:
  static constexpr int kFrames = 100, kRound = 80;

  std::string kind() const override { return "round"; }
  std::int64_t size() const override { return kFrames; }
  bool posed() const override { return false; }
  FrameRead read(std::int64_t position) const override {
    Frame frame = camera_.take(truth(position), position);
    frame.posed = false;
    return {std::move(frame), ""};
  }
  static Pose truth(std::int64_t position) {
    const double angle = 2 * M_PI * static_cast<double>(position) / kRound;
    Pose pose = fixture::room_pose(10);
    pose.translation() += 0.5 * Eigen::Vector3d(std::sin(angle), 0, 1 - std::cos(angle));
    pose.linear() = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()).matrix() * pose.linear();
    return pose;
  }

 private:
  fixture::RoomCamera camera_;
};

MapperConfig finely_keeping() {
  MapperConfig config;
  config.map.voxel_size_m = 0.02f;
  config.frame_store.max_mb = 100;
  return config;
}

/// Any loop is closed, however little it moves.
LoopConfig eager() {
  LoopConfig config;
  config.min_path_m = 1.5f;
  config.agreeing = 1;
  config.least_voxels = 0;
  config.pause_m = 0.2f;
  return config;
}

struct RoundTrip {
  explicit RoundTrip(const LoopConfig& loops, const MapperConfig& config = finely_keeping())
      : mapper(config), finder(Tracker(TrackConfig{}), loops) {
    const RoundInARoom source;
    done =
        run_sequence(source, positions({}, source.size()), mapper, nullptr, {}, nullptr, &finder);
  }
  double furthest_m() const {
    double furthest = 0;
    for (const FrameLogEntry& frame : done.frames)
      furthest =
          std::max(furthest, fixture::distance_m(RoundInARoom::truth(0) * frame.world_from_camera,
                                                 RoundInARoom::truth(frame.index)));
    return furthest;
  }

  Mapper mapper;
  PoseFinder finder;
  SequenceResult done;
};

TEST(PoseFinder, ClosesLoopsWhileFramesCome) {
  const RoundTrip trip(eager());
  EXPECT_GT(trip.finder.corrections().times, 0u);
  EXPECT_EQ(trip.done.frames.size(), std::size_t{RoundInARoom::kFrames});
  EXPECT_LT(trip.furthest_m(), 0.03);
  const RoundTrip again(eager());
  EXPECT_EQ(trip.mapper.map().content_hash(), again.mapper.map().content_hash());
}

TEST(PoseFinder, LeavesLittleToTheEnd) {
  LoopConfig loops = eager();
  loops.least_voxels = 1000;
  EXPECT_EQ(RoundTrip(loops).finder.corrections().times, 0u);
  loops = eager();
  loops.online = false;
  EXPECT_EQ(RoundTrip(loops).finder.corrections().times, 0u);
}

/// All is left to the end: what is closed there is closed alike when it is done again from a map
/// that was stored before.
TEST(PoseFinder, ClosesTheLastLoopsAfterTheLastFrame) {
  LoopConfig loops = eager();
  loops.online = false;
  RoundTrip trip(loops), again(loops);
  const double before = trip.furthest_m();
  const LoopReport report =
      close_last_loops(trip.mapper, trip.done.frames, trip.done.depth_camera, TrackConfig{}, loops);
  EXPECT_GT(report.closed, 0u);
  EXPECT_LE(trip.furthest_m(), std::max(before, 0.03));
  close_last_loops(again.mapper, again.done.frames, again.done.depth_camera, TrackConfig{}, loops);
  EXPECT_EQ(trip.mapper.map().content_hash(), again.mapper.map().content_hash());
}

TEST(PoseFinder, WithoutKeptFramesLoopsStayOpen) {
  MapperConfig config = finely_keeping();
  config.frame_store.max_mb = 0;
  EXPECT_EQ(RoundTrip(eager(), config).finder.corrections().times, 0u);
}

}  // namespace
}  // namespace ovimap
