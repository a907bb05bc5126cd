// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/frame/camera_rig.h"

#include <gtest/gtest.h>

#include "ovimap/base/error_fixture.h"
#include "ovimap/frames/recording/sequence_fixture.h"

namespace ovimap {
namespace {

CameraRig applied(const std::string& yaml, CameraRig rig = {}) {
  const fixture::TemporaryFolder folder;
  write_text(folder.path() / "calibration.yaml", yaml);
  apply_calibration(folder.path() / "calibration.yaml", rig);
  return rig;
}

std::string rig_fault(const std::string& yaml) {
  return error_of([&] { applied(yaml); });
}

TEST(CameraRig, EveryKeyIsOptional) {
  CameraRig before;
  before.depth_camera = before.color_camera = {640, 480, 585.f, 585.f, 320.f, 240.f};
  EXPECT_EQ(applied("", before).depth_camera, before.depth_camera);
  const CameraRig rig = applied("depth_camera: {fx: 500}\ncolor_camera: {cy: 232.8}\n", before);
  EXPECT_EQ(rig.depth_camera, (PinholeCamera{640, 480, 500.f, 585.f, 320.f, 240.f}));
  EXPECT_EQ(rig.color_camera, (PinholeCamera{640, 480, 585.f, 585.f, 320.f, 232.8f}));
  EXPECT_EQ(rig.depth_units_per_m, 1000);
  EXPECT_TRUE(rig.color_from_depth.matrix().isIdentity());
}

TEST(CameraRig, ReadsEveryKey) {
  const CameraRig rig = applied(
      "camera: {width: 10, height: 8, fx: 9, fy: 9, cx: 4.5, cy: 3.5}\n"
      "depth_camera: {depth_scale: 5000, invalid: [0, 65535]}\n"
      "color_camera: {width: 20, height: 16, fx: 18}\n"
      "color_from_depth: {rotation_vector: [0, 0, 1.5707963267948966], translation: [1, 2, 3]}\n"
      "poses: {direction: camera_from_world, axes: opengl, camera: color}\n");
  EXPECT_EQ(rig.depth_camera, (PinholeCamera{10, 8, 9.f, 9.f, 4.5f, 3.5f}));
  EXPECT_EQ(rig.color_camera, (PinholeCamera{20, 16, 18.f, 9.f, 4.5f, 3.5f}));
  EXPECT_EQ(rig.depth_units_per_m, 5000);
  EXPECT_EQ(rig.invalid_depth, (std::vector<std::uint16_t>{0, 65535}));
  // A quarter turn about z takes x to y.
  EXPECT_TRUE((rig.color_from_depth * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(1, 3, 3)));
  EXPECT_EQ(rig.poses.direction, PoseConvention::Direction::kCameraFromWorld);
  EXPECT_EQ(rig.poses.axes, PoseConvention::Axes::kOpenGl);
  EXPECT_EQ(rig.poses.camera, PoseConvention::Camera::kColor);
}

TEST(CameraRig, TextReadsBackAsTheSameRig) {
  CameraRig rig;
  rig.depth_camera = {640, 480, 585.1f, 585.f, 320.25f, 240.f};
  rig.color_camera = {1296, 968, 1170.19f, 1170.2f, 647.75f, 483.75f};
  rig.color_from_depth.linear() =
      Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  rig.color_from_depth.translation() = Eigen::Vector3d(-0.024, 0.0034, 0.1 / 3);
  rig.depth_units_per_m = 6553.5;
  rig.invalid_depth = {0, 7, 65535};
  rig.poses.axes = PoseConvention::Axes::kOpenGl;
  rig.color_lens = {Lens::Model::kKannalaBrandt, {.05, -.02, .006, 1. / 3}};
  rig.depth_lens = {Lens::Model::kBrownConrady, {.1, -.2, .01, .02, .03, 0, 1e-7, -4}};
  const CameraRig back = applied(calibration_text(rig));
  EXPECT_EQ(back.color_lens, rig.color_lens);
  EXPECT_EQ(back.depth_lens, rig.depth_lens);
  EXPECT_EQ(back.depth_camera, rig.depth_camera);
  EXPECT_EQ(back.color_camera, rig.color_camera);
  EXPECT_TRUE(back.color_from_depth.isApprox(rig.color_from_depth, 1e-14));
  EXPECT_EQ(back.depth_units_per_m, rig.depth_units_per_m);
  EXPECT_EQ(back.invalid_depth, rig.invalid_depth);
  EXPECT_EQ(back.poses.axes, rig.poses.axes);
}

TEST(CameraRig, ReadsTheLensOfEachCameraAndOfBoth) {
  const Lens five{Lens::Model::kBrownConrady, {.1, -.2, .01, .02, .03}};
  CameraRig rig = applied("camera: {distortion: {coefficients: [.1, -.2, .01, .02, .03]}}");
  EXPECT_EQ(rig.color_lens, five);
  EXPECT_EQ(rig.depth_lens, five);
  rig = applied(
      "depth_camera: {distortion: {model: none}}\n"
      "color_camera: {distortion: {model: kannala_brandt, coefficients: [1, 2, 3, 4]}}\n",
      rig);
  EXPECT_EQ(rig.depth_lens, Lens{});
  EXPECT_EQ(rig.color_lens, (Lens{Lens::Model::kKannalaBrandt, {1, 2, 3, 4}}));
}

TEST(CameraRig, StoredPosesAreTakenToTheDepthCamera) {
  CameraRig rig;
  rig.color_from_depth.translation() = Eigen::Vector3d(0.1, 0, 0);
  const Pose pose = fixture::room_pose(3);
  EXPECT_TRUE(rig.world_from_depth_camera(pose.matrix()).isApprox(pose, 1e-12));
  rig.poses.direction = PoseConvention::Direction::kCameraFromWorld;
  EXPECT_TRUE(rig.world_from_depth_camera(pose.inverse().matrix()).isApprox(pose, 1e-12));
  rig.poses = {};
  rig.poses.axes = PoseConvention::Axes::kOpenGl;
  const Eigen::Matrix4d flipped = pose.matrix() * Eigen::Vector4d(1, -1, -1, 1).asDiagonal();
  EXPECT_TRUE(rig.world_from_depth_camera(flipped).isApprox(pose, 1e-12));
  rig.poses.axes = PoseConvention::Axes::kRos;
  // One metre ahead of the camera is the body's x axis, right of it is -y, below it is -z.
  const Pose body = Pose::Identity();
  const Pose ours = rig.world_from_depth_camera(body.matrix());
  EXPECT_TRUE((ours * Eigen::Vector3d(2, 3, 4)).isApprox(Eigen::Vector3d(4, -2, -3)));
  rig.poses = {};
  rig.poses.camera = PoseConvention::Camera::kColor;
  const Pose world_from_color = pose * rig.color_from_depth.inverse();
  EXPECT_TRUE(rig.world_from_depth_camera(world_from_color.matrix()).isApprox(pose, 1e-12));
}

TEST(CameraRig, FaultsNameKeyValueAndRemedy) {
  EXPECT_NE(rig_fault("depth_camera: {fx: abc}")
                .find("depth_camera.fx is 'abc'; accepted is a number above 0"),
            std::string::npos);
  EXPECT_NE(rig_fault("depth_camera: {fx: -5}").find("'-5'"), std::string::npos);
  EXPECT_NE(rig_fault("color_camera: {width: 64.5}").find("a whole number from 1 to 32767"),
            std::string::npos);
  EXPECT_NE(rig_fault("depth_camera: {focal: 3}").find("no key 'depth_camera.focal'"),
            std::string::npos);
  EXPECT_NE(rig_fault("colour_camera: {fx: 3}").find("did you mean 'color_camera'"),
            std::string::npos);
  EXPECT_NE(rig_fault("color_from_depth: {translation: [1, 2]}").find("a list of three numbers"),
            std::string::npos);
  EXPECT_NE(rig_fault("color_from_depth: {translation: [1, 2, .nan]}")
                .find("color_from_depth.translation"),
            std::string::npos);
  EXPECT_NE(rig_fault("depth_camera: {invalid: [70000]}").find("'70000'"), std::string::npos);
  const auto lens_fault = [](const std::string& lens) {
    return rig_fault("color_camera: {distortion: {" + lens + "}}");
  };
  EXPECT_NE(lens_fault("coefficients: [1, 2, 3, 4]")
                .find("color_camera.distortion.coefficients is '[1, 2, 3, 4]'; accepted is a list "
                      "of 5 or 8 numbers"),
            std::string::npos);
  EXPECT_NE(lens_fault("model: kannala_brandt").find("a list of 4 numbers"), std::string::npos);
  EXPECT_NE(lens_fault("model: division").find("none or brown_conrady or kannala_brandt"),
            std::string::npos);
  EXPECT_NE(lens_fault("coefficients: [1, 2, 3, 4, x]").find("'x'"), std::string::npos);
  EXPECT_NE(lens_fault("k1: 3").find("no key 'color_camera.distortion.k1'"), std::string::npos);
  EXPECT_NE(rig_fault("depth_camera: 5").find("a mapping"), std::string::npos);
  EXPECT_NE(rig_fault("poses: {axes: blender}").find("opencv or opengl or ros"), std::string::npos);
  EXPECT_NE(rig_fault("a: [1, 2\nb: }").find("is not YAML"), std::string::npos);
  EXPECT_NE(rig_fault("just text").find("calibration.yaml"), std::string::npos);
}

}  // namespace
}  // namespace ovimap
