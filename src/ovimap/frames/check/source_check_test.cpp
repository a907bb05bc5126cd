// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/check/source_check.h"

#include <algorithm>
#include <limits>

#include <gtest/gtest.h>

#include "ovimap/base/config.h"
#include "ovimap/base/parallel.h"
#include "ovimap/frames/recording/sequence_fixture.h"

namespace ovimap {
namespace {

namespace fs = std::filesystem;

CheckReport check(const fs::path& path) {
  FrameSourceConfig unlimited;
  unlimited.min_depth_m = 0;
  unlimited.max_depth_m = std::numeric_limits<float>::max();
  unlimited.poses = PoseNeed::kAllOrNone;
  return check_source(*open_frame_source(path, unlimited));
}

const Finding* find(const CheckReport& report, const std::string& name) {
  for (const Finding& finding : report.findings)
    if (finding.name == name) return &finding;
  return nullptr;
}

std::string faults_of(const CheckReport& report) {
  std::string names;
  for (const Finding& finding : report.findings)
    if (finding.severity == Severity::kFault) names += finding.name + ": " + finding.message + "\n";
  return names;
}

fixture::Sequence two_camera_sequence() {
  fixture::Sequence sequence;
  sequence.frames = 24;
  sequence.color_from_depth.translation().x() = 0.02;
  return sequence;
}

CheckReport check_written(const fixture::Sequence& sequence) {
  const fixture::TemporaryFolder folder;
  fixture::write_seven_scenes(folder.path(), sequence);
  return check(folder.path());
}

void expect_single_fault(const CheckReport& report, const std::string& name,
                         const std::string& remedy) {
  EXPECT_FALSE(report.ok());
  const auto faults =
      std::count_if(report.findings.begin(), report.findings.end(),
                    [](const Finding& f) { return f.severity == Severity::kFault; });
  EXPECT_EQ(faults, 1) << faults_of(report);
  const Finding* finding = find(report, name);
  ASSERT_NE(finding, nullptr) << faults_of(report);
  EXPECT_EQ(finding->severity, Severity::kFault);
  EXPECT_NE(finding->remedy.find(remedy), std::string::npos) << finding->remedy;
}

TEST(SourceCheck, GoodSequenceIsFineInEveryLayout) {
  fixture::Sequence sequence;
  sequence.frames = 24;
  const fixture::TemporaryFolder root;
  const fs::path scenes = root.path() / "7scenes", tum = root.path() / "tum",
                 plain = root.path() / "plain";
  for (const fs::path& folder : {scenes, tum, plain}) fs::create_directories(folder);
  fixture::write_seven_scenes(scenes, two_camera_sequence());
  fixture::write_tum(tum, sequence);
  fixture::write_folder(plain, sequence);
  std::string poses;
  for (int i = 0; i < sequence.frames; ++i) poses += fixture::matrix_text(sequence.pose(i), ' ', 3);
  write_text(plain / "poses.txt", poses);
  for (const fs::path& path : {fixture::write_replica(root.path(), sequence), scenes, tum, plain}) {
    const CheckReport report = check(path);
    EXPECT_TRUE(report.ok()) << path << "\n" << faults_of(report);
    EXPECT_EQ(report.usable, 24) << path;
    EXPECT_GT(report.depth_agreement, 0.9) << path;
    EXPECT_NEAR(report.median_depth_m, 2.5, 1.2) << path;
    EXPECT_EQ(report.valid_share, 1) << path;
    for (const Finding& finding : report.findings)
      EXPECT_EQ(finding.severity, Severity::kOk) << path << " " << finding.message;
  }
}

TEST(SourceCheck, InvertedPosesAreNamedAndTheRemedyHelps) {
  fixture::Sequence sequence = two_camera_sequence();
  sequence.stored_pose = [](const Pose& pose) { return pose.inverse().matrix(); };
  const fixture::TemporaryFolder folder;
  fixture::write_seven_scenes(folder.path(), sequence);
  expect_single_fault(check(folder.path()), "pose_convention", "direction: camera_from_world");
  write_text(folder.path() / "calibration.yaml",
             fixture::calibration_yaml(sequence) + "poses: {direction: camera_from_world}\n");
  EXPECT_TRUE(check(folder.path()).ok());
}

TEST(SourceCheck, AxisConventionsAreNamed) {
  fixture::Sequence sequence = two_camera_sequence();
  sequence.stored_pose = [](const Pose& pose) -> Eigen::Matrix4d {
    return pose.matrix() * Eigen::Vector4d(1, -1, -1, 1).asDiagonal();
  };
  expect_single_fault(check_written(sequence), "pose_convention", "{axes: opengl}");
  sequence.stored_pose = [](const Pose& pose) -> Eigen::Matrix4d {
    Eigen::Matrix4d ours_from_body;
    ours_from_body << 0, -1, 0, 0, 0, 0, -1, 0, 1, 0, 0, 0, 0, 0, 0, 1;
    return pose.matrix() * ours_from_body;
  };
  expect_single_fault(check_written(sequence), "pose_convention", "{axes: ros}");
  sequence.stored_pose = [](const Pose& pose) -> Eigen::Matrix4d {
    return (pose.matrix() * Eigen::Vector4d(1, -1, -1, 1).asDiagonal()).inverse();
  };
  expect_single_fault(check_written(sequence), "pose_convention",
                      "{direction: camera_from_world, axes: opengl}");
}

TEST(SourceCheck, DepthScalesAreNamed) {
  // What is stored, what is said of it, and what has to be done.
  struct Case {
    double stored, said;
    const char* remedy;
  };
  for (const Case& c :
       {Case{5000, 1000, "multiply depth_scale by 5"}, Case{1000, 5000, "divide depth_scale by 5"},
        Case{1000, 100, "multiply depth_scale by 10"},
        Case{1000, 1, "multiply depth_scale by 1000"},
        Case{6553.5, 1000, "multiply depth_scale by 6.5535"}}) {
    fixture::Sequence sequence = two_camera_sequence();
    sequence.depth_units_per_m = c.stored;
    const fixture::TemporaryFolder folder;
    fixture::write_seven_scenes(folder.path(), sequence);
    sequence.depth_units_per_m = c.said;
    write_text(folder.path() / "calibration.yaml", fixture::calibration_yaml(sequence));
    expect_single_fault(check(folder.path()), "depth_scale", c.remedy);
  }
}

TEST(SourceCheck, PosesInMillimetresAreNamed) {
  fixture::Sequence sequence = two_camera_sequence();
  sequence.stored_pose = [](const Pose& pose) {
    Eigen::Matrix4d matrix = pose.matrix();
    matrix.topRightCorner<3, 1>() *= 1000;
    return matrix;
  };
  expect_single_fault(check_written(sequence), "pose_unit", "in metres");
}

TEST(SourceCheck, IdenticalPosesAreAFaultWhenImagesChange) {
  fixture::Sequence sequence = two_camera_sequence();
  sequence.stored_pose = [](const Pose&) { return fixture::room_pose(0).matrix(); };
  expect_single_fault(check_written(sequence), "still_poses", "pose for each frame");
}

TEST(SourceCheck, PosesOfOtherFramesAreAFaultWithoutAFalseName) {
  fixture::Sequence sequence = two_camera_sequence();
  int next = 0;
  sequence.stored_pose = [&next](const Pose&) {
    return fixture::room_pose(17 * next++ % 24).matrix();
  };
  const CheckReport report = check_written(sequence);
  EXPECT_FALSE(report.ok());
  EXPECT_NE(find(report, "agreement"), nullptr) << faults_of(report);
}

TEST(SourceCheck, BadFramesAreCountedByFault) {
  const fixture::Sequence sequence = two_camera_sequence();
  const fixture::TemporaryFolder folder;
  fixture::write_seven_scenes(folder.path(), sequence);
  const auto file = [&](int frame, const char* ending) {
    return folder.path() / ("frame-" + fixture::padded(frame, 6) + ending);
  };
  for (const int frame : {3, 9}) fs::remove(file(frame, ".depth.png"));
  write_text(file(5, ".pose.txt"), "nan 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1");
  CheckReport report = check(folder.path());
  EXPECT_TRUE(report.ok()) << faults_of(report);
  EXPECT_EQ(report.checked, 24);
  EXPECT_EQ(report.usable, 21);
  ASSERT_EQ(report.faults.size(), 2u);
  EXPECT_EQ(report.faults[0].phrase, "is missing");
  EXPECT_EQ(report.faults[0].example, "frame-000003.depth.png: is missing");
  EXPECT_EQ(report.faults[0].frames, 2);
  EXPECT_EQ(report.faults[1].phrase, "has a bad pose (not finite)");
  EXPECT_EQ(find(report, "frames")->severity, Severity::kWarning);
  for (int frame = 0; frame < 20; ++frame) fs::remove(file(frame, ".color.png"));
  report = check(folder.path());
  EXPECT_FALSE(report.ok());
  EXPECT_EQ(find(report, "frames")->severity, Severity::kFault);
}

TEST(SourceCheck, WithoutPosesTheRestIsChecked) {
  fixture::Sequence sequence;
  sequence.frames = 24;
  const fixture::TemporaryFolder folder;
  fixture::write_folder(folder.path(), sequence);
  const CheckReport report = check(folder.path());
  EXPECT_TRUE(report.ok()) << faults_of(report);
  EXPECT_EQ(report.usable, 24);
  ASSERT_NE(find(report, "poses"), nullptr);
  EXPECT_NE(find(report, "registration"), nullptr);
  EXPECT_EQ(find(report, "agreement"), nullptr);
  EXPECT_EQ(find(report, "depth_scale")->severity, Severity::kOk);
}

TEST(SourceCheck, NothingIsCalledFineWhereNoFrameIsUsable) {
  const fixture::Sequence sequence = two_camera_sequence();
  const fixture::TemporaryFolder folder;
  fixture::write_seven_scenes(folder.path(), sequence);
  for (int frame = 0; frame < sequence.frames; ++frame)
    write_text(folder.path() / ("frame-" + fixture::padded(frame, 6) + ".depth.png"), "no image");
  const CheckReport report = check(folder.path());
  EXPECT_FALSE(report.ok());
  for (const Finding& finding : report.findings) EXPECT_EQ(finding.severity, Severity::kFault);
}

TEST(SourceCheck, UnregisteredLayoutTakenAsOneCameraIsAWarning) {
  fixture::Sequence sequence;
  sequence.frames = 6;
  const CheckReport report = check_written(sequence);
  EXPECT_EQ(find(report, "registration")->severity, Severity::kWarning);
  EXPECT_NE(find(report, "registration")->remedy.find("calibration.yaml"), std::string::npos);
}

TEST(SourceCheck, OneFrameIsEnoughToReport) {
  fixture::Sequence sequence = two_camera_sequence();
  sequence.frames = 1;
  const CheckReport report = check_written(sequence);
  EXPECT_TRUE(report.ok());
  EXPECT_EQ(report.usable, 1);
}

TEST(SourceCheck, ThreadsDoNotChangeTheReport) {
  fixture::Sequence sequence = two_camera_sequence();
  sequence.stored_pose = [](const Pose& pose) { return pose.inverse().matrix(); };
  const CheckReport many = check_written(sequence);
  const ThreadLimit one(1);
  const CheckReport alone = check_written(sequence);
  EXPECT_EQ(alone.depth_agreement, many.depth_agreement);
  EXPECT_EQ(faults_of(alone), faults_of(many));
}

TEST(SourceCheck, ListsItsFields) {
  SourceCheckConfig config;
  ConfigFields fields;
  list_fields(config, fields);
  fields.set("max_frames", "8");
  EXPECT_EQ(config.max_frames, 8);
  EXPECT_THROW(fields.set("min_gain", "2"), Error);
}

TEST(SourceCheck, KitchenPasses) {
  const fs::path kitchen = OVIMAP_SOURCE_DIR "/../shared/data/kitchen";
  if (!fs::exists(kitchen)) GTEST_SKIP() << "no kitchen recording at " << kitchen;
  const CheckReport report = check(kitchen);
  EXPECT_TRUE(report.ok()) << faults_of(report);
  EXPECT_LE(report.checked, 80);
  EXPECT_GT(report.depth_agreement, 0.8);
  EXPECT_NEAR(report.median_depth_m, 1.8, 0.8);
  for (const Finding& finding : report.findings)
    EXPECT_EQ(finding.severity, Severity::kOk) << finding.name << ": " << finding.message;
}

TEST(SourceCheck, MistakesInTheKitchenAreNamed) {
  const fs::path kitchen = OVIMAP_SOURCE_DIR "/../shared/data/kitchen";
  if (!fs::exists(kitchen)) GTEST_SKIP() << "no kitchen recording at " << kitchen;
  const fixture::TemporaryFolder folder;
  for (const auto& entry : fs::directory_iterator(kitchen))
    fs::create_symlink(fs::absolute(entry.path()), folder.path() / entry.path().filename());
  fs::remove(folder.path() / "calibration.yaml");
  const std::string color_camera =
      "color_camera: {width: 640, height: 480, fx: 531.1, fy: 531.1, cx: 318.9, cy: 232.8}\n"
      "color_from_depth: {rotation_vector: [-0.0062, 0.0025, 0.0087], translation: [-0.0240, "
      "0.0034, 0.0120]}\n";
  struct Case {
    const char *mistake, *name, *remedy;
  };
  for (const Case& c :
       {Case{"poses: {direction: camera_from_world}", "pose_convention",
             "direction: camera_from_world"},
        Case{"poses: {axes: opengl}", "pose_convention", "axes: opengl"},
        Case{"depth_camera: {depth_scale: 5000}", "depth_scale", "divide depth_scale by 5"},
        Case{"depth_camera: {depth_scale: 100}", "depth_scale", "multiply depth_scale by 10"}}) {
    write_text(folder.path() / "calibration.yaml", color_camera + c.mistake + "\n");
    expect_single_fault(check(folder.path()), c.name, c.remedy);
  }
}

}  // namespace
}  // namespace ovimap
