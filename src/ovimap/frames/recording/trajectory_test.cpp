// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/recording/trajectory.h"

#include <gtest/gtest.h>

#include "ovimap/frames/recording/sequence_fixture.h"

namespace ovimap {
namespace {

Trajectory read(const std::string& text) {
  const fixture::TemporaryFolder folder;
  write_text(folder.path() / "poses.txt", text);
  return read_trajectory(folder.path() / "poses.txt");
}

TEST(Trajectory, ReadsEveryKindOfLine) {
  const Eigen::Matrix4d pose = fixture::room_pose(5).matrix();
  const Trajectory trajectory =
      read("# comment\n" + fixture::matrix_text(pose, ' ') + fixture::matrix_text(pose, ' ', 3) +
           "7.5 " + fixture::tum_text(pose) + "\n");
  ASSERT_EQ(trajectory.size(), 3u);
  for (const TrajectoryPose& line : trajectory) {
    ASSERT_TRUE(line.matrix);
    EXPECT_TRUE(line.matrix->isApprox(pose, 1e-8));
  }
  EXPECT_EQ(trajectory[1].origin, "poses.txt line 3");
  EXPECT_FALSE(trajectory[0].time_s);
  EXPECT_EQ(trajectory[2].time_s, 7.5);
}

TEST(Trajectory, BrokenLineKeepsItsPlace) {
  const std::string pose = fixture::matrix_text(Eigen::Matrix4d::Identity(), ' ');
  const Trajectory trajectory = read(pose + "1 2 3\n" + pose);
  ASSERT_EQ(trajectory.size(), 3u);
  EXPECT_FALSE(trajectory[1].matrix);
  EXPECT_TRUE(trajectory[2].matrix);
}

TEST(Trajectory, FileWithoutAnyPoseIsAnError) {
  EXPECT_THROW(read("1 2 3\nhello\n"), Error);
  EXPECT_THROW(read(""), Error);
  EXPECT_THROW(read_trajectory("no-such-file.txt"), Error);
}

TEST(PoseTimeline, FindsTheNearestWithinTheGap) {
  // Not in order of time, as after two recordings were joined.
  const Trajectory trajectory = read("3 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n2 2 0 0 0 0 0 1\n");
  const PoseTimeline timeline(trajectory);
  EXPECT_EQ(timeline.nearest(1.2, 0.5), &trajectory[1]);
  EXPECT_EQ(timeline.nearest(1.8, 0.5), &trajectory[2]);
  EXPECT_EQ(timeline.nearest(0.6, 0.5), &trajectory[1]);
  EXPECT_EQ(timeline.nearest(3.4, 0.5), &trajectory[0]);
  EXPECT_EQ(timeline.nearest(3.6, 0.5), nullptr);
  EXPECT_EQ(timeline.nearest(2.0, 0), &trajectory[2]);
  EXPECT_EQ(PoseTimeline({}).nearest(1, 10), nullptr);
}

TEST(PoseTimeline, InterpolatesBetweenPosesWithinTheGap) {
  const Trajectory trajectory =
      read("1 0 0 0 0 0 0 1\n2 1 0 0 0 0 0.7071067811865476 0.7071067811865476\n9 5 0 0 0 0 0 1\n");
  const PoseTimeline timeline(trajectory);
  const auto pose = timeline.at(1.25, 1);
  ASSERT_TRUE(pose);
  EXPECT_NEAR((*pose->matrix)(0, 3), 0.25, 1e-12);
  EXPECT_NEAR(std::atan2((*pose->matrix)(1, 0), (*pose->matrix)(0, 0)), M_PI / 8, 1e-12);
  EXPECT_EQ(pose->origin, "poses.txt line 1");
  EXPECT_NEAR((*timeline.at(1.25, 0.5)->matrix)(0, 3), 0, 1e-12);  // the other is too far away
  EXPECT_NEAR((*timeline.at(8.5, 1)->matrix)(0, 3), 5, 1e-12);
  EXPECT_FALSE(timeline.at(5, 1));
  EXPECT_NEAR((*timeline.at(2, 1)->matrix)(0, 3), 1, 1e-12);
}

TEST(AssignByLine, ByRankWhenCountsAgreeElseByNumber) {
  Trajectory trajectory(3);
  for (int i = 0; i < 3; ++i) {
    trajectory[static_cast<std::size_t>(i)].matrix = fixture::room_pose(i).matrix();
    trajectory[static_cast<std::size_t>(i)].origin = concat("line ", i);
  }
  std::vector<RecordedFrame> three(3), two(2);
  assign_by_line(trajectory, {10, 20, 30}, three);
  EXPECT_EQ(three[1].pose_origin, "line 1");
  assign_by_line(trajectory, {2, 7}, two);
  EXPECT_EQ(two[0].pose_origin, "line 2");
  EXPECT_FALSE(two[1].pose);
}

}  // namespace
}  // namespace ovimap
