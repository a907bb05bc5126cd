// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// `ovimap eval-changes` on two visits to a rendered room.
#include <sstream>

#include <Eigen/Geometry>

#include "program_fixture.h"

namespace ovimap {
namespace {

using nlohmann::json;

class ChangesProgramTest : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    const std::string as = " --masks gt --encoder none --set map.voxel_size_m=0.02 ";
    ASSERT_EQ(run("synth room --room tiny --seed 5 --visits 2 --frames 30 --size 160x120").code, 0);
    ASSERT_EQ(run("run room/visit1" + as + "-o home.ovimap").code, 0);
    ASSERT_EQ(run("run room/visit2" + as + "--continue home.ovimap").code, 0);
  }
  json scores() const { return run_json("eval-changes home.ovimap room --json"); }
};

TEST_F(ChangesProgramTest, WhatMovedOutOfSightIsKnownToHaveLeft) {
  const json found = scores();
  for (const char* kind : {"moved", "removed", "added"})
    EXPECT_EQ(found[kind]["right"], found[kind]["told"]) << found;
  EXPECT_EQ(found["moved"]["right"], 3) << found;
  EXPECT_EQ(found["removed"]["right"], 1) << found;
  EXPECT_EQ(found["added"]["right"], 1) << found;
  EXPECT_EQ(found["ids_kept"], 3) << found;

  const json elsewhere = {{"min", {90, 90, 0}}, {"max", {91, 91, 1}}};
  json truth = json::parse(slurp(path("room/changes.json")));
  for (json& change : truth["changes"]) {
    if (change["kind"] == "moved") continue;
    change[change["kind"] == "removed" ? "to" : "from"] = elsewhere;
    change["kind"] = "moved";
  }
  write_text(path("room/changes.json"), truth.dump());
  EXPECT_EQ(scores(), found) << "nobody could see where they are";
}

/// The second visit sees next to nothing, so what changed before it is news in the third.
TEST_F(ChangesProgramTest, WhatNobodySawInTimeIsTrueLater) {
  const std::string as = " --masks gt --encoder none --set map.voxel_size_m=0.02 ";
  ASSERT_EQ(run("synth late --room tiny --seed 5 --visits 3 --frames 30 --size 160x120").code, 0);
  const std::filesystem::path hasty = path("late/visit2");
  const std::string poses = slurp(hasty / "traj.txt");
  std::size_t end = 0;
  for (int frame = 0; frame < 3; ++frame) end = poses.find('\n', end) + 1;
  write_text(hasty / "traj.txt", poses.substr(0, end));
  for (const auto& file : std::filesystem::directory_iterator(hasty / "results"))
    if (const std::string name = file.path().stem().string();
        name.substr(name.size() - 6) > "000002")
      std::filesystem::remove(file);
  ASSERT_EQ(run("run late/visit1" + as + "-o late.ovimap").code, 0);
  for (const char* visit : {"visit2", "visit3"})
    ASSERT_EQ(run(concat("run late/", visit, as, "--continue late.ovimap")).code, 0);
  const json removed = run_json("eval-changes late.ovimap late --json")["removed"];
  EXPECT_EQ(removed["right"], removed["told"]) << removed;
  EXPECT_GE(removed["right"], 2) << removed;
}

/// The recording with its poses in a world of its own.
class AlignedVisitTest : public ChangesProgramTest {
 protected:
  void move_poses(const Eigen::Isometry3d& world_from_room) {
    std::istringstream rows(poses_);
    std::ostringstream moved;
    moved.precision(12);
    for (std::string line; std::getline(rows, line);) {
      std::istringstream numbers(line);
      Eigen::Matrix4d pose;
      for (int i = 0; i < 16; ++i) numbers >> pose(i / 4, i % 4);
      pose = world_from_room.matrix() * pose;
      for (int i = 0; i < 16; ++i) moved << pose(i / 4, i % 4) << (i < 15 ? ' ' : '\n');
    }
    write_text(path("room/visit2/traj.txt"), moved.str());
  }
  /// By how far the map's world and where the run took the room to be differ.
  static double error_m(const json& told, const Eigen::Isometry3d& world_from_room) {
    Eigen::Isometry3d map_from_recording;
    for (int i = 0; i < 16; ++i)
      map_from_recording.matrix()(i / 4, i % 4) =
          told["map_from_recording"][static_cast<std::size_t>(i)];
    const Eigen::Vector3d corner(3, 3, 1);
    return (map_from_recording * (world_from_room * corner) - corner).norm();
  }
  void SetUp() override {
    ChangesProgramTest::SetUp();
    poses_ = slurp(path("room/visit2/traj.txt"));
    ASSERT_EQ(run("run room/visit1" + as_ + "-o first.ovimap").code, 0);
  }

  const std::string as_ = " --masks gt --encoder none --set map.voxel_size_m=0.02 ";
  std::string poses_;
};

TEST_F(AlignedVisitTest, PosesThatDriftedAreMovedBack) {
  Eigen::Isometry3d off = Eigen::Isometry3d::Identity();
  off.translation() = Eigen::Vector3d(0.03, 0.02, 0);
  off.rotate(Eigen::AngleAxisd(0.02, Eigen::Vector3d::UnitZ()));
  move_poses(off);
  const std::string go_on = "run room/visit2" + as_ + "--continue first.ovimap -o next.ovimap";
  const ProgramResult refused = run(go_on);
  EXPECT_NE(refused.code, 0);
  EXPECT_NE(refused.err.find("--align"), std::string::npos) << refused.err;
  EXPECT_LT(error_m(run_json(go_on + " --align --json"), off), 0.015);
}

TEST_F(AlignedVisitTest, AnotherWorldIsFoundByObjects) {
  Eigen::Isometry3d off = Eigen::Isometry3d::Identity();
  off.translation() = Eigen::Vector3d(-7, 4, 0.3);
  off.rotate(Eigen::AngleAxisd(2, Eigen::Vector3d::UnitZ()));
  move_poses(off);
  const json told =
      run_json("run room/visit2" + as_ + "--continue first.ovimap -o next.ovimap --align --json");
  EXPECT_LT(error_m(told, off), 0.015);
  const json found = run_json("eval-changes next.ovimap room --json");
  EXPECT_GE(found["ids_kept"], 2) << found;
}

}  // namespace
}  // namespace ovimap
