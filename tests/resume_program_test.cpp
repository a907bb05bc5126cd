// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <random>
#include <thread>
#include <utility>

#include "ovimap/io/map_file/map_checkpoint.h"
#include "ovimap/io/map_file/map_file.h"
#include "ovimap/map/voxels/block_tiles.h"
#include "program_fixture.h"

namespace ovimap {
namespace {

class ResumeProgramTest : public ProgramTest {
 protected:
  /// Long enough for a busy disk to store a checkpoint before it ends.
  ResumeProgramTest() {
    sequence_.frames = 30;
    std::filesystem::create_directories(path("long"));
    fixture::write_replica(path("long"), sequence_);
  }

  static constexpr const char* kRun =
      "run long/scene --masks gt --encoder none --set checkpoint.frames=1 --set "
      "map.voxel_size_m=0.03 ";

  /// Starts the program and kills it, unless it has ended, once it has been seen writing to the log
  /// of its checkpoint so often, and `delay` after that. Returns whether it had ended.
  bool run_and_kill(const std::vector<std::string>& arguments, int writes,
                    std::chrono::milliseconds delay) const {
    auto log = checkpoint_log();
    const pid_t child = ::fork();
    if (child == 0) execute(arguments);
    while (writes > 0 && !has_ended(child)) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      const auto now = checkpoint_log();
      if (std::exchange(log, now) != now) --writes;
    }
    std::this_thread::sleep_for(delay);
    ::kill(child, SIGKILL);
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
  }

  /// When the checkpoint's log was last written to; the epoch when there is none.
  std::filesystem::file_time_type checkpoint_log() const {
    std::error_code absent;
    const auto time = std::filesystem::last_write_time(path("room.ovimap.partial-wal"), absent);
    return absent ? std::filesystem::file_time_type() : time;
  }

  /// Leaves its status to waitpid.
  static bool has_ended(pid_t child) {
    siginfo_t info{};
    return ::waitid(P_PID, static_cast<id_t>(child), &info, WEXITED | WNOHANG | WNOWAIT) != 0 ||
           info.si_pid != 0;
  }

  [[noreturn]] void execute(const std::vector<std::string>& arguments) const {
    (void)!::nice(10);  // on a busy machine, too, its killer must see what it writes
    std::vector<char*> words = {const_cast<char*>(OVIMAP_PROGRAM)};
    for (const std::string& word : arguments) words.push_back(const_cast<char*>(word.c_str()));
    words.push_back(nullptr);
    const int log = ::open(path("killed.txt").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
    if (::chdir(folder_.path().c_str()) != 0 || ::dup2(log, 1) < 0 || ::dup2(log, 2) < 0) _exit(90);
    ::execv(OVIMAP_PROGRAM, words.data());
    _exit(91);
  }

  /// Leaves what a run leaves that is killed after the frames of `map`.
  void store_as_checkpoint(const std::string& map, const std::string& checkpoint_file) const {
    const MapDocument document = load_map(path(map));
    MapCheckpoint checkpoint{
        document, document.map.config(), document.map.labels(), document.map.block_count(), {}};
    checkpoint.record.unfinished = true;
    for (const Tile& tile : tiles_of(document.map))
      checkpoint.tiles.push_back({tile.key, tile.present, blocks_of(document.map, tile)});
    CheckpointFile(path(checkpoint_file), CheckpointFile::Start::kAnew).write(checkpoint);
  }

  /// What makes two maps the same, whenever they were made.
  nlohmann::json essence(const std::string& map) const {
    const nlohmann::json info = run_json("info " + map + " --json");
    return {info["content_hash"], info["instances"], info["frames"], info["mask_frames"]};
  }
};

TEST_F(ResumeProgramTest, AHundredKillsLoseNothing) {
  const auto start = std::chrono::steady_clock::now();
  ASSERT_EQ(run(std::string(kRun) + "-o whole.ovimap").code, 0);
  const std::chrono::duration<double, std::milli> takes = std::chrono::steady_clock::now() - start;
  const nlohmann::json expected = essence("whole.ovimap");
  std::mt19937 random(7);
  std::int64_t frames = 0;
  int finished = 0, with_checkpoint = 0;
  for (int kill = 0; kill < 100; ++kill) {
    // A quarter at any moment, the others between the first checkpoints.
    const bool any_moment = kill % 4 == 0;
    const int writes = any_moment ? 0 : std::uniform_int_distribution(1, 8)(random);
    const double longest_ms = any_moment ? takes.count() : 10;
    const std::chrono::milliseconds delay(
        std::uniform_int_distribution(0, static_cast<int>(longest_ms))(random));
    const bool done = run_and_kill(
        {"run", "long/scene", "--masks", "gt", "--encoder", "none", "--set", "checkpoint.frames=1",
         "--set", "map.voxel_size_m=0.03", "-o", "room.ovimap", "--resume"},
        writes, delay);
    if (done) {
      ++finished;
      frames = 0;
      EXPECT_EQ(essence("room.ovimap"), expected) << "after kill " << kill;
      std::filesystem::remove(path("room.ovimap"));
    } else if (std::filesystem::exists(path("room.ovimap"))) {  // killed while it cleaned up
      EXPECT_EQ(essence("room.ovimap"), expected) << "after kill " << kill;
    } else if (const ProgramResult info = run("info room.ovimap.partial --json"); info.code == 0) {
      const std::int64_t saved = nlohmann::json::parse(info.out)["frames"];
      EXPECT_GE(saved, frames) << "after kill " << kill;
      frames = saved;
      ++with_checkpoint;
    } else {
      EXPECT_EQ(frames, 0) << "kill " << kill << " lost a checkpoint: " << info.err;
    }
  }
  ASSERT_EQ(run(std::string(kRun) + "-o room.ovimap --resume").code, 0);
  EXPECT_EQ(essence("room.ovimap"), expected);
  EXPECT_FALSE(std::filesystem::exists(path("room.ovimap.partial")));
  EXPECT_GT(with_checkpoint + finished, 20) << "the kills came too early to mean anything";
  EXPECT_GT(with_checkpoint, 10) << "hardly a kill came between two checkpoints";
}

TEST_F(ResumeProgramTest, GoesOnWithAMap) {
  ASSERT_EQ(run(std::string(kRun) + "-o room.ovimap --frames :3").code, 0);
  const nlohmann::json resumed = run_json(std::string(kRun) + "-o room.ovimap --resume --json");
  EXPECT_GT(resumed["frames"], 3);
  ASSERT_EQ(run(std::string(kRun) + "-o whole.ovimap").code, 0);
  EXPECT_EQ(essence("room.ovimap")[0], essence("whole.ovimap")[0]);
  EXPECT_EQ(run(std::string(kRun) + "-o room.ovimap --resume").code, 0) << "nothing is left to do";
  expect_complaint("run long/scene --masks none -o room.ovimap --resume", {"masks gt", "--resume"});
  expect_complaint(std::string(kRun) + "-o room.ovimap --resume --set map.voxel_size_m=0.02",
                   {"voxel_size_m", "0.02"});
  std::filesystem::rename(path("long/scene"), path("long/another"));
  expect_complaint("run long/another --masks gt --encoder none -o room.ovimap --resume",
                   {"long/scene", "long/another", "--continue"});
}

TEST_F(ResumeProgramTest, ALiveRunThatWasKilledIsRepeatedWithItsPause) {
  const std::vector<std::string> live = {"run",       "long/scene",
                                         "--masks",   "gt",
                                         "--encoder", "none",
                                         "--set",     "checkpoint.frames=1",
                                         "--set",     "map.voxel_size_m=0.03",
                                         "-o",        "room.ovimap",
                                         "--live",    "--fps",
                                         "30"};
  ASSERT_FALSE(run_and_kill(live, 3, std::chrono::milliseconds(0)));
  ASSERT_EQ(run(std::string(kRun) + "-o room.ovimap --live --fps 30 --resume").code, 0);
  const nlohmann::json again =
      run_json(std::string(kRun) + "--repeat room.ovimap -o again.ovimap --json");
  EXPECT_EQ(again["repeated"]["same"], true) << again["repeated"];
  ASSERT_EQ(run("edit room.ovimap rename 1 pot").code, 0);
  const ProgramResult other = run(std::string(kRun) + "--repeat room.ovimap -o again.ovimap");
  EXPECT_EQ(other.code, 1);
  EXPECT_NE(other.out.find("differ in: corrected_"), std::string::npos) << other.out;
}

TEST_F(ResumeProgramTest, AnotherVisitGoesOnWithAMap) {
  ASSERT_EQ(run(std::string(kRun) + "-o home.ovimap").code, 0);
  const nlohmann::json home = run_json("info home.ovimap --json");
  const std::string id = std::to_string(home["instances"][0]["id"].get<int>());
  ASSERT_EQ(run("edit home.ovimap rename " + id + " ball").code, 0);
  const std::string before = slurp(path("home.ovimap"));
  ASSERT_EQ(run(std::string(kRun) + "--continue home.ovimap -o new.ovimap").code, 0);
  EXPECT_TRUE(slurp(path("home.ovimap")) == before);
  const nlohmann::json after = run_json("info new.ovimap --json");
  EXPECT_EQ(after["frames"], 2 * home["frames"].get<int>());
  EXPECT_EQ(after["instances"].size(), home["instances"].size());
  EXPECT_EQ(after["instances"][0]["name"], "ball");
  EXPECT_EQ(after["history"]["visits"].size(), 2u);
  EXPECT_TRUE(after["history"]["events"].empty()) << after["history"]["events"].dump();
  const ProgramResult again = run(std::string(kRun) + "--continue home.ovimap");
  ASSERT_EQ(again.code, 0) << "the map itself";
  EXPECT_NE(again.err.find("is in the map already"), std::string::npos) << again.err;
  EXPECT_EQ(essence("home.ovimap"), essence("new.ovimap"));
  EXPECT_EQ(run(std::string(kRun) + "--continue home.ovimap --threads 1 -o third.ovimap").code, 0);
  const ProgramResult history = run("info third.ovimap --history");
  EXPECT_NE(history.out.find("visit 3, 30 frames"), std::string::npos) << history.out;
}

/// Corrections that are made while another visit is mapped are in the map that replaces it; a map
/// that is merged has no past.
TEST_F(ResumeProgramTest, AVisitKeepsWhatIsCorrectedMeanwhile) {
  ASSERT_EQ(run(std::string(kRun) + "-o room.ovimap").code, 0);
  const auto ids = run_json("info room.ovimap --json")["instances"];
  const std::string id = std::to_string(ids[0]["id"].get<int>());
  const pid_t visit = ::fork();
  if (visit == 0)
    execute({"run", "long/scene", "--masks", "gt", "--encoder", "none", "--set",
             "map.voxel_size_m=0.03", "--live", "--fps", "5", "--continue", "room.ovimap"});
  EXPECT_EQ(run("edit room.ovimap rename " + id + " 'tea pot'").code, 0);
  int status = 0;
  ::waitpid(visit, &status, 0);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  EXPECT_NE(run("edit room.ovimap log").out.find("tea pot"), std::string::npos);
  EXPECT_EQ(run_json("info room.ovimap --json")["history"]["visits"].size(), 2u);
  ASSERT_EQ(run(std::string(kRun) + "-o other.ovimap").code, 0);
  expect_complaint("merge other.ovimap room.ovimap -o room.ovimap", {"several visits", "-o"});
  const ProgramResult merged = run("merge other.ovimap room.ovimap -o both.ovimap");
  EXPECT_EQ(merged.code, 0);
  EXPECT_NE(merged.err.find("room.ovimap is of several visits"), std::string::npos) << merged.err;
}

TEST_F(ResumeProgramTest, ALiveVisitGoesOnWithAMap) {
  ASSERT_EQ(run(std::string(kRun) + "-o home.ovimap").code, 0);
  const std::string before = slurp(path("home.ovimap"));
  const std::string visit = std::string(kRun) + "--live --fps 100 --continue home.ovimap ";
  ASSERT_EQ(run(visit + "-o live.ovimap").code, 0);
  EXPECT_TRUE(slurp(path("home.ovimap")) == before);
  const nlohmann::json history = run_json("info live.ovimap --json")["history"];
  EXPECT_EQ(history["visits"].size(), 2u);
  EXPECT_TRUE(history["events"].empty()) << history["events"].dump();
  expect_complaint(std::string(kRun) + "--repeat live.ovimap -o again.ovimap", {"several visits"});
  ASSERT_EQ(run(visit).code, 0) << "the map itself";
  EXPECT_EQ(run_json("info home.ovimap --json")["history"]["visits"].size(), 2u);
}

TEST_F(ResumeProgramTest, AVisitThatWasKilledGoesOn) {
  ASSERT_EQ(run(std::string(kRun) + "-o home.ovimap").code, 0);
  const std::string visit = std::string(kRun) + "--continue home.ovimap ";
  ASSERT_EQ(run(visit + "-o whole.ovimap").code, 0);
  ASSERT_EQ(run(visit + "--frames :7 -o part.ovimap").code, 0);
  store_as_checkpoint("part.ovimap", "room.ovimap.partial");
  expect_complaint(visit + "-o room.ovimap", {"unfinished", "--resume"});
  expect_complaint(std::string(kRun) + "-o room.ovimap --resume", {"--continue"});
  ASSERT_EQ(run(visit + "-o room.ovimap --resume").code, 0);
  EXPECT_EQ(essence("room.ovimap"), essence("whole.ovimap"));
}

TEST_F(ResumeProgramTest, AVisitThatDoesNotFitChangesNothing) {
  sequence_.depth_camera = sequence_.color_camera = {160, 120, 140.f, 140.f, 79.5f, 59.5f};
  fixture::write_replica(path("long"), sequence_);
  ASSERT_EQ(run(std::string(kRun) + "-o home.ovimap").code, 0);
  const std::string before = slurp(path("home.ovimap"));
  sequence_.stored_pose = [](const Pose& pose) {
    Eigen::Matrix4d off = pose.matrix();
    off.topRightCorner<3, 1>() += Eigen::Vector3d(0.03, 0.02, 0.02);
    return off;
  };
  std::filesystem::create_directories(path("off"));
  fixture::write_replica(path("off"), sequence_);
  expect_complaint(
      "run off/scene --masks gt --encoder none --set map.voxel_size_m=0.03 --continue home.ovimap",
      {"does not fit", "cm", "align"});
  expect_complaint(
      "run off/scene --masks gt --encoder none --set map.voxel_size_m=0.03 -o home.ovimap --resume",
      {"another recording", "--continue"});
  expect_complaint("run long/scene --masks gt --encoder none --continue home.ovimap",
                   {"map.voxel_size_m"});
  expect_complaint("run long/scene --masks gt --encoder none", {"-o", "--continue"});
  EXPECT_TRUE(slurp(path("home.ovimap")) == before);
  EXPECT_FALSE(std::filesystem::exists(path("home.ovimap.partial")));
}

TEST_F(ResumeProgramTest, AFullDiskLeavesTheLastCheckpoint) {
  ASSERT_EQ(run(std::string(kRun) + "-o whole.ovimap").code, 0);
  // A limit on file size stands in for the full disk. How much a few checkpoints take is not known
  // beforehand, so the disk is made larger until one of them is on it.
  ProgramResult result;
  for (int kilobytes = 64; kilobytes < 100000 && run("info room.ovimap.partial").code != 0;
       kilobytes = kilobytes * 3 / 2)
    result = run("config > unused.txt; (ulimit -f " + std::to_string(kilobytes) +
                 "; trap '' XFSZ; '" OVIMAP_PROGRAM "' " + kRun + "-o room.ovimap)");
  EXPECT_EQ(result.code, 2);
  EXPECT_NE(result.err.find("cannot write map"), std::string::npos) << result.err;
  EXPECT_GT(run_json("info room.ovimap.partial --json")["frames"], 0);
  EXPECT_FALSE(std::filesystem::exists(path("room.ovimap")));
  ASSERT_EQ(run(std::string(kRun) + "-o room.ovimap --resume").code, 0);
  EXPECT_EQ(essence("room.ovimap"), essence("whole.ovimap"));
}

TEST_F(ResumeProgramTest, WhatAKillLeftBeforeTheFirstCheckpointGoes) {
  std::ofstream(path("room.ovimap.partial"));
  ASSERT_EQ(run("run long/scene --masks gt --encoder none -o room.ovimap").code, 0);
  EXPECT_FALSE(std::filesystem::exists(path("room.ovimap.partial")));
}

TEST_F(ResumeProgramTest, ABoundOnMemoryDoesNotChangeTheMap) {
  const std::string fine =
      "run replica/scene --masks gt --encoder none --set checkpoint.frames=4 --set "
      "map.voxel_size_m=0.02 ";
  ASSERT_EQ(run(fine + "-o whole.ovimap").code, 0);
  const std::string bounded = fine + "-o room.ovimap --max-memory 20M";
  const nlohmann::json report = run_json(bounded + " --json");
  EXPECT_GT(report["tiles_evicted"], 0);
  EXPECT_EQ(essence("room.ovimap"), essence("whole.ovimap"));
  const nlohmann::json info = run_json("info room.ovimap --json");
  EXPECT_EQ(info["tiles_evicted"], report["tiles_evicted"]);
  EXPECT_EQ(info["tiles_loaded"], report["tiles_loaded"]);
  EXPECT_FALSE(std::filesystem::exists(path("room.ovimap.partial")));

  std::filesystem::remove(path("room.ovimap"));
  ASSERT_EQ(run(bounded + " --frames :6").code, 0);
  ASSERT_EQ(run(bounded + " --resume").code, 0);
  EXPECT_EQ(essence("room.ovimap"), essence("whole.ovimap"));

  expect_complaint(fine + "-o small.ovimap --max-memory 5M",
                   {"one frame", "--max-memory", "voxel_size_m"});
  expect_complaint(fine + "-o small.ovimap --max-memory 300", {"'300'", "300M"});
}

TEST_F(ResumeProgramTest, AnUnfinishedRunIsNotOverwritten) {
  ASSERT_EQ(run(std::string(kRun) + "-o part.ovimap --frames :3").code, 0);
  store_as_checkpoint("part.ovimap", "room.ovimap.partial");
  EXPECT_NE(run("info room.ovimap.partial").out.find("unfinished"), std::string::npos);
  expect_complaint(std::string(kRun) + "-o room.ovimap",
                   {"room.ovimap.partial", "--resume", "delete"});
  EXPECT_EQ(run(std::string(kRun) + "-o room.ovimap --resume").code, 0);
  EXPECT_FALSE(std::filesystem::exists(path("room.ovimap.partial")));
}

}  // namespace
}  // namespace ovimap
