// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/wait.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "ovimap/frames/recording/sequence_fixture.h"

namespace ovimap {

struct ProgramResult {
  int code = -1;
  std::string out, err;
};

inline std::string slurp(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

/// Runs the built program as a user's shell would, in a temporary folder of its own that holds a
/// small analytic recording ("recording", Replica layout with truth ids: "replica/scene").
class ProgramTest : public ::testing::Test {
 protected:
  ProgramTest() {
    std::filesystem::create_directories(path("recording"));
    fixture::write_seven_scenes(path("recording"), sequence_);
    std::filesystem::create_directories(path("replica"));
    fixture::write_replica(path("replica"), sequence_);
  }

  std::filesystem::path path(const std::string& name) const { return folder_.path() / name; }

  ProgramResult run(const std::string& arguments) const {
    const std::string command = "cd '" + folder_.path().string() + "' && '" OVIMAP_PROGRAM "' " +
                                arguments + " > out.txt 2> err.txt < /dev/null";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, slurp(path("out.txt")),
            slurp(path("err.txt"))};
  }

  /// The user's fault: exit code 2 and one line on stderr that says all of `words`.
  void expect_complaint(const std::string& arguments,
                        std::initializer_list<const char*> words) const {
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.code, 2) << arguments << "\n" << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    for (const char* word : words)
      EXPECT_NE(result.err.find(word), std::string::npos)
          << "no '" << word << "' in: " << result.err;
  }

  nlohmann::json run_json(const std::string& arguments) const {
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.code, 0) << arguments << "\n" << result.err;
    return nlohmann::json::parse(result.out, nullptr, false);
  }

  /// Files in the test's folder, to see that nothing half-written stays behind.
  std::size_t file_count() const {
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_.path()))
      count += entry.is_regular_file();
    return count;
  }

  fixture::Sequence sequence_;
  fixture::TemporaryFolder folder_;
};

/// A model folder of the inference tests, quoted for the shell. Its weights are random: what it
/// finds means nothing, but everything else about it is real.
inline std::string golden_model(const std::string& name) {
  return "'" OVIMAP_SOURCE_DIR "/src/ovimap/inference/testdata/golden_" + name + "'";
}
constexpr const char* kGoldenModels = "'" OVIMAP_SOURCE_DIR "/src/ovimap/inference/testdata'";

/// ... and maps that recording with embeddings.
class EncodedProgramTest : public ProgramTest {
 protected:
  /// What so few pixels, centimetres apart, need.
  static constexpr const char* kSmallPictures =
      " --set views.min_mask_px=20 --set views.min_first_depth_px=10 --set views.min_depth_px=10 "
      "--set summary.min_instance_views=1 --set views.min_frames_seen=1 --set "
      "map.voxel_size_m=0.02";

  /// Writes room.ovimap.
  void map_with(const std::string& encoder, const std::string& options = "") const {
    const ProgramResult result = run("run replica/scene --masks gt -o room.ovimap --encoder " +
                                     encoder + kSmallPictures + options);
    ASSERT_EQ(result.code, 0) << result.err;
  }
};

}  // namespace ovimap
