// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "ovimap/track/room_camera_fixture.h"
#include "program_fixture.h"

namespace ovimap {
namespace {

/// A recording without poses ("unposed"), and the true ones beside it ("truth.txt").
class TrackProgramTest : public ProgramTest {
 protected:
  TrackProgramTest() {
    sequence_.depth_camera = sequence_.color_camera = {320, 240, 280.f, 280.f, 159.5f, 119.5f};
    sequence_.frames = 20;
    std::filesystem::create_directories(path("unposed"));
    fixture::write_folder(path("unposed"), sequence_);
    std::string truth;
    for (int i = 0; i < sequence_.frames; ++i)
      truth += concat(i / 30., " ", fixture::tum_text(sequence_.pose(i)), "\n");
    write_text(path("truth.txt"), truth);
  }
  /// Makes a frame one of darkness: nothing near enough to be depth.
  void cover(int frame) const {
    const Image<std::uint16_t> dark(320, 240, 20);  // 2 cm
    write_file(path("unposed") / "depth" / concat(frame, ".png"), encode_png(dark));
  }
  /// Writes a frame of the recording that shows the room from somewhere else, by a sensor that
  /// reads so much too far.
  void show(int frame, const Pose& pose, float too_far = 1) const {
    fixture::RoomCamera camera;
    camera.camera = sequence_.depth_camera;
    const Frame taken = camera.take(pose);
    Image<std::uint16_t> depth(320, 240);
    std::transform(taken.depth.begin(), taken.depth.end(), depth.begin(), [&](float metres) {
      return static_cast<std::uint16_t>(std::lround(1000 * too_far * metres));
    });
    write_file(path("unposed") / "depth" / concat(frame, ".png"), encode_png(depth));
    write_file(path("unposed") / "color" / concat(frame, ".png"), encode_png(taken.color));
  }
  static Pose behind(int frame) {
    Pose pose = fixture::room_pose(frame);
    pose.rotate(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitY()));
    return pose;
  }
  static constexpr const char* kRun =
      "run unposed --set map.voxel_size_m=0.02 --trajectory poses.txt -o map.ovimap ";
};

TEST_F(TrackProgramTest, MapsARecordingWithoutPoses) {
  const ProgramResult result = run(kRun);
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_NE(result.out.find("tracked 20 of 20 frames, lost 0 times"), std::string::npos)
      << result.out;
  const auto scores = run_json("eval-poses poses.txt truth.txt --json");
  EXPECT_EQ(scores["matched"], 20);
  EXPECT_LT(scores["ate_m"]["rmse"], 0.015);
}

TEST_F(TrackProgramTest, IsTheSameForAnyNumberOfThreads) {
  EXPECT_EQ(run(std::string(kRun) + "--threads 1").code, 0);
  const std::string one = slurp(path("poses.txt"));
  EXPECT_EQ(run(std::string(kRun) + "--threads 3").code, 0);
  EXPECT_EQ(one, slurp(path("poses.txt")));
}

TEST_F(TrackProgramTest, LiveTracksAsWell) {
  const auto report = run_json(std::string(kRun) + "--live --fps 5 --json");
  EXPECT_EQ(report["tracking"]["frames_tracked"], report["frames"]);
  EXPECT_EQ(report["live"]["frames_lost"], 0);
}

TEST_F(TrackProgramTest, ALiveRunIsRepeatedWithItsPoses) {
  for (int frame : {7, 8}) cover(frame);
  const std::string live = "run unposed --poses track --masks none --set map.voxel_size_m=0.03 ";
  const auto hurried =
      run_json(live + "--live --fps 30 -o map.ovimap --trajectory live.txt --json");
  const auto repeated =
      run_json(live + "--repeat map.ovimap -o again.ovimap --trajectory again.txt --json");
  EXPECT_EQ(repeated["repeated"]["same"], true) << repeated["repeated"];
  EXPECT_EQ(slurp(path("live.txt")), slurp(path("again.txt")));
  EXPECT_EQ(repeated["tracking"]["frames_tracked"], hurried["tracking"]["frames_tracked"]);
}

TEST_F(TrackProgramTest, GivenPosesArePredictionsToRefine) {
  const auto report =
      run_json("run recording --poses refine --set map.voxel_size_m=0.03 -o map.ovimap --json");
  EXPECT_EQ(report["tracking"]["frames_tracked"], report["frames"]);
}

TEST_F(TrackProgramTest, ACoveredLensIsToldAndMapsNothing) {
  for (int frame : {9, 10, 11}) cover(frame);
  const auto report = run_json(std::string(kRun) + "--json");
  EXPECT_EQ(report["frames"], 17);
  EXPECT_EQ(report["tracking"]["frames_tracked"], 17);
}

TEST_F(TrackProgramTest, ACameraThatIsLostForMostFramesIsTold) {
  for (int frame = 3; frame < 20; ++frame) show(frame, behind(frame));
  const ProgramResult done = run(kRun);
  EXPECT_EQ(done.code, 1);
  EXPECT_NE(done.err.find("followed in 3 of 20 frames only"), std::string::npos) << done.err;
}

/// Two recordings in one: the second has a map of its own, and nothing of it is in the first.
TEST_F(TrackProgramTest, WhatIsNowhereIsMappedByItself) {
  const std::string run_to = std::string(kRun) + "--set track.part_frames=8 --json";
  for (int frame = 8; frame < 20; ++frame) show(frame, behind(frame));
  const auto report = run_json(run_to);
  EXPECT_EQ(report["frames"], 8);
  const auto& parts = report["tracking"]["parts"];
  ASSERT_EQ(parts.size(), 1u);
  EXPECT_EQ(parts[0]["first"], 8);
  EXPECT_EQ(parts[0]["last"], 19);
  EXPECT_EQ(parts[0]["frames"], 12);
  EXPECT_NE(parts[0]["by_objects"]["doubt"], "") << "the map shows nothing of that place";
  EXPECT_EQ(run_json("info map.part2.ovimap --json")["frames"], 12);
  ASSERT_EQ(run(std::string(kRun) + "--frames :8").code, 0);
  const auto alone = run_json("info map.ovimap --json");
  ASSERT_EQ(run(run_to).code, 0);
  EXPECT_EQ(run_json("info map.ovimap --json")["content_hash"], alone["content_hash"]);
  EXPECT_FALSE(std::filesystem::exists(path("map.part2.ovimap.partial")));
}

TEST_F(TrackProgramTest, AFewLostFramesAreNoPart) {
  for (int frame : {9, 10, 11}) show(frame, behind(frame));
  const auto report = run_json(std::string(kRun) + "--set track.part_frames=8 --json");
  EXPECT_EQ(report["frames"], 17);
  EXPECT_TRUE(report["tracking"]["parts"].empty());
  EXPECT_FALSE(std::filesystem::exists(path("map.part2.ovimap")));
}

/// A recording that goes to and fro with a sensor that warms up, so that the camera drifts, and is
/// killed while its loops are closed.
class KilledClosureTest : public TrackProgramTest {
 protected:
  KilledClosureTest() {
    for (int frame = 0; frame < 20; ++frame)
      show(frame, fixture::room_pose(std::min(frame, 19 - frame)),
           1 + 0.001f * static_cast<float>(frame));
  }
  /// The one checkpoint is made before the last loops are closed. Poses that shake make them move.
  static constexpr const char* kClose =
      "run unposed --poses track --masks none --encoder none --set map.voxel_size_m=0.012 --set "
      "loops.online=false --set loops.min_path_m=0.1 --set checkpoint.seconds=100000 --set "
      "loops.step_sigma_m=0.1 --set track.keyframe_step_m=0.04 --resume -o map.ovimap";

  using Clock = std::chrono::steady_clock;

  /// Kills the program so long after it has begun to write its checkpoint, unless it ends before.
  /// Returns how long it went on.
  Clock::duration run_and_kill(Clock::duration delay) const {
    const pid_t child = ::fork();
    if (child == 0) execute();
    const auto log = path("map.ovimap.partial-wal");
    int status = 0;
    const auto is_running = [&] { return ::waitpid(child, &status, WNOHANG) == 0; };
    const auto wait = [] { std::this_thread::sleep_for(std::chrono::milliseconds(1)); };
    while (!std::filesystem::exists(log) && is_running()) wait();
    const auto begun = Clock::now();
    while (is_running()) {
      if (Clock::now() - begun >= delay) {
        ::kill(child, SIGKILL);
        ::waitpid(child, &status, 0);
        break;
      }
      wait();
    }
    return Clock::now() - begun;
  }
  [[noreturn]] void execute() const {
    const int out = ::open(path("killed.txt").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
    if (::chdir(folder_.path().c_str()) != 0 || ::dup2(out, 1) < 0 || ::dup2(out, 2) < 0)
      ::_exit(90);
    const std::string command = concat("exec '", OVIMAP_PROGRAM, "' ", kClose);
    ::execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
    ::_exit(91);
  }
};

TEST_F(KilledClosureTest, ResumesToTheSameMap) {
  const Clock::duration whole = run_and_kill(std::chrono::hours(1));
  const auto expected = run_json("info map.ovimap --json")["content_hash"];
  std::filesystem::remove(path("map.ovimap"));
  const auto report = run_json(std::string(kClose) + " --json");
  EXPECT_GT(report["tracking"]["loops_closed"], 0);
  EXPECT_GT(report["tracking"]["loop_moved_m"], 0.006) << "the map was not fused anew";
  int closing = 0;
  Clock::duration delay = whole / 2;  // a busy machine is slower from one run to the next
  for (int tries = 0; tries < 20 && closing == 0; ++tries) {
    std::filesystem::remove(path("map.ovimap"));
    run_and_kill(delay);
    const ProgramResult partial = run("info map.ovimap.partial --json");
    const bool done = std::filesystem::exists(path("map.ovimap"));
    closing += !done && partial.code == 0 &&
               nlohmann::json::parse(partial.out)["frames"] == sequence_.frames;
    if (!done) {
      ASSERT_EQ(run(kClose).code, 0) << tries;
    }
    EXPECT_EQ(run_json("info map.ovimap --json")["content_hash"], expected) << tries;
    delay = done ? delay / 2 : delay + whole / 8;
  }
  EXPECT_GT(closing, 0) << "no kill came between the last frame and the map";
}

/// The map keeps no frames, and so has no keyframes. A bare room has few objects to tell a place
/// by.
TEST_F(TrackProgramTest, ObjectsSayWhereAVisitBegins) {
  ASSERT_EQ(run(std::string(kRun) + "--frames :14").code, 0);
  const std::string visit =
      "run unposed --frames 6: --poses track --continue map.ovimap --set map.voxel_size_m=0.02 "
      "--trajectory poses.txt -o visit.ovimap --json ";
  expect_complaint(visit, {"keeps no frames", "too few objects say so (objects 2"});
  expect_complaint(visit + "--set visit.object_frames=0", {"keeps no frames"});
  const auto report = run_json(visit + "--set visit.alignment.min_objects=2");
  EXPECT_EQ(report["tracking"]["frames_tracked"], 14);
  EXPECT_EQ(report["tracking"]["by_objects"]["doubt"], "");
  EXPECT_GT(report["tracking"]["by_objects"]["overlap"], 0.9);
  EXPECT_EQ(run_json("info visit.ovimap --json")["frames"], 28);
}

TEST_F(TrackProgramTest, AVisitThatBeginsElsewhereIsToldToBeginInTheMap) {
  ASSERT_EQ(run(std::string(kRun) + "--set frame_store.max_mb=100").code, 0);
  for (int frame = 0; frame < 12; ++frame) show(frame, behind(frame));
  const ProgramResult visit =
      run("run unposed --live --fps 1000 --poses track --set live.queue=20 --continue map.ovimap "
          "--set map.voxel_size_m=0.02 -o visit.ovimap");
  EXPECT_NE(visit.err.find("followed in 8 of 20 frames only: no frame before"), std::string::npos)
      << visit.err;
}

TEST_F(TrackProgramTest, WhatNeedsPosesSaysSo) {
  const ProgramResult checked = run("check unposed");  // the rest can be
  EXPECT_EQ(checked.code, 0) << checked.err;
  EXPECT_NE(checked.out.find("`ovimap run` finds them itself"), std::string::npos) << checked.out;
  expect_complaint("run unposed --poses given -o map.ovimap", {"no poses"});
  expect_complaint("eval-poses truth.txt poses.txt", {"poses.txt"});
}

}  // namespace
}  // namespace ovimap
