// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <random>
#include <thread>

#include "program_fixture.h"

namespace ovimap {
namespace {

class ResumeProgramTest : public ProgramTest {
 protected:
  static constexpr const char* kRun =
      "run replica/scene --masks gt --encoder none --set checkpoint.frames=1 ";

  /// Starts the program, kills it after a while unless it has ended, and returns whether it had.
  bool run_and_kill(const std::vector<std::string>& arguments, std::chrono::milliseconds after) {
    const pid_t child = ::fork();
    if (child == 0) execute(arguments);
    std::this_thread::sleep_for(after);
    ::kill(child, SIGKILL);
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
  }

  [[noreturn]] void execute(const std::vector<std::string>& arguments) const {
    std::vector<char*> words = {const_cast<char*>(OVIMAP_PROGRAM)};
    for (const std::string& word : arguments) words.push_back(const_cast<char*>(word.c_str()));
    words.push_back(nullptr);
    const int log = ::open(path("killed.txt").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
    if (::chdir(folder_.path().c_str()) != 0 || ::dup2(log, 1) < 0 || ::dup2(log, 2) < 0) _exit(90);
    ::execv(OVIMAP_PROGRAM, words.data());
    _exit(91);
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
  std::uniform_real_distribution<double> moment(0.2, 1.1);
  std::int64_t frames = 0;
  int finished = 0, with_checkpoint = 0;
  for (int kill = 0; kill < 100; ++kill) {
    const bool done =
        run_and_kill({"run", "replica/scene", "--masks", "gt", "--encoder", "none", "--set",
                      "checkpoint.frames=1", "-o", "room.ovimap", "--resume"},
                     std::chrono::duration_cast<std::chrono::milliseconds>(takes * moment(random)));
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
}

TEST_F(ResumeProgramTest, GoesOnWithAMap) {
  ASSERT_EQ(run(std::string(kRun) + "-o room.ovimap --frames :3").code, 0);
  const nlohmann::json resumed = run_json(std::string(kRun) + "-o room.ovimap --resume --json");
  EXPECT_GT(resumed["frames"], 3);
  ASSERT_EQ(run(std::string(kRun) + "-o whole.ovimap").code, 0);
  EXPECT_EQ(essence("room.ovimap")[0], essence("whole.ovimap")[0]);
  EXPECT_EQ(run(std::string(kRun) + "-o room.ovimap --resume").code, 0) << "nothing is left to do";
  expect_complaint("run replica/scene --masks none -o room.ovimap --resume",
                   {"masks gt", "--resume"});
  expect_complaint(std::string(kRun) + "-o room.ovimap --resume --set map.voxel_size_m=0.02",
                   {"voxel_size_m", "0.02"});
}

TEST_F(ResumeProgramTest, AnUnfinishedRunIsNotOverwritten) {
  for (std::chrono::milliseconds delay(20); run("info room.ovimap.partial").code != 0;
       delay += std::chrono::milliseconds(20)) {
    std::filesystem::remove(path("room.ovimap"));  // it had ended before
    const pid_t child = ::fork();
    if (child == 0)
      execute({"run", "replica/scene", "-o", "room.ovimap", "--resume", "--set",
               "checkpoint.frames=1"});
    while (!std::filesystem::exists(path("room.ovimap.partial-wal")) &&
           ::waitpid(child, nullptr, WNOHANG) == 0)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    std::this_thread::sleep_for(delay);
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
  }
  EXPECT_NE(run("info room.ovimap.partial").out.find("unfinished"), std::string::npos);
  expect_complaint("run replica/scene -o room.ovimap",
                   {"room.ovimap.partial", "--resume", "delete"});
  EXPECT_EQ(run("run replica/scene -o room.ovimap --resume").code, 0);
  EXPECT_FALSE(std::filesystem::exists(path("room.ovimap.partial")));
}

}  // namespace
}  // namespace ovimap
