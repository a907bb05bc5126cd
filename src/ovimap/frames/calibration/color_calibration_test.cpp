// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/calibration/color_calibration.h"

#include <cmath>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

#include "ovimap/base/config.h"
#include "ovimap/base/parallel.h"
#include "ovimap/frames/frame/camera_rig.h"
#include "ovimap/frames/recording/sequence_fixture.h"

namespace ovimap {
namespace {

/// Boards that face the camera at distances of 1 to 4 metres, before a wall.
struct Board {
  Eigen::Vector3d center;
  double half_width, half_height;
  Rgb8 color;
};

std::vector<Board> random_boards(int count) {
  std::mt19937 random(7);
  const auto between = [&random](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / std::mt19937::max();
  };
  std::vector<Board> boards = {{{0, 0, 4.5}, 20, 20, {120, 118, 110}}};
  for (int i = 0; i < count; ++i) {
    const double z = between(1, 4);
    const auto shade = [&] { return static_cast<std::uint8_t>(between(0, 255)); };
    boards.push_back({{z * between(-0.8, 0.8), z * between(-0.6, 0.6), z},
                      z * between(0.03, 0.1),
                      z * between(0.03, 0.1),
                      {shade(), shade(), shade()}});
  }
  return boards;
}

/// A camera that walks along the boards and looks at them through two lenses.
class BoardSource final : public FrameSource {
 public:
  ColorView truth;
  PinholeCamera depth_camera{320, 240, 260, 260, 159.5f, 119.5f};
  std::vector<Board> boards = random_boards(30);
  ColorView given{depth_camera, Pose::Identity()};  ///< what the frames say
  bool known_lens = false;                          ///< given with the frames
  bool still = false;                               ///< the camera does not move
  bool grey = false;                                ///< colour shows nothing
  int frames = 12;

  BoardSource() { truth = given; }

  std::string kind() const override { return "boards"; }
  std::int64_t size() const override { return frames; }
  bool rectified() const override { return known_lens; }
  FrameRead read(std::int64_t position) const override {
    Frame frame;
    frame.index = position;
    frame.depth_camera = depth_camera;
    frame.color_camera = given.camera;
    frame.color_from_depth = given.color_from_depth;
    frame.world_from_camera = pose(still ? 0 : static_cast<int>(position));
    frame.depth = DepthImage(depth_camera.width, depth_camera.height);
    frame.color = RgbImage(truth.camera.width, truth.camera.height);
    draw({depth_camera}, frame.world_from_camera, [&](int u, int v, const Board&, double z) {
      frame.depth.at(u, v) = static_cast<float>(z);
    });
    draw(truth, frame.world_from_camera * truth.color_from_depth.inverse(),
         [&](int u, int v, const Board& board, double) {
           frame.color.at(u, v) = grey ? Rgb8{128, 128, 128} : board.color;
         });
    return {std::move(frame), {}};
  }

 private:
  static Pose pose(int index) {
    Pose pose = Pose::Identity();
    pose.linear() =
        Eigen::AngleAxisd(0.01 * index - 0.05, Eigen::Vector3d::UnitY()).toRotationMatrix();
    pose.translation() = Eigen::Vector3d(0.06 * index - 0.3, 0.03 * (index % 3), 0);
    return pose;
  }

  /// The ray that the lens bends to `bent`, by iteration.
  static Eigen::Vector3d straight(const Lens& lens, const Eigen::Vector2d& bent) {
    Eigen::Vector2d ray = bent;
    for (int i = 0; i < 20; ++i) ray += bent - lens.bend(ray);
    return ray.homogeneous();
  }

  template <class Paint>
  void draw(const ColorView& view, const Pose& world_from_camera, const Paint& paint) const {
    const PinholeCamera& camera = view.camera;
    const Eigen::Vector3d eye = world_from_camera.translation();
    for (int v = 0; v < camera.height; ++v)
      for (int u = 0; u < camera.width; ++u) {
        const Eigen::Vector3d ray =
            world_from_camera.linear() *
            straight(view.lens, {(u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy});
        double nearest = 1e9;
        const Board* seen = nullptr;
        for (const Board& board : boards) {
          const double depth = (board.center.z() - eye.z()) / ray.z();
          const Eigen::Vector3d off = eye + depth * ray - board.center;
          if (depth < nearest && std::abs(off.x()) < board.half_width &&
              std::abs(off.y()) < board.half_height)
            nearest = depth, seen = &board;
        }
        if (seen != nullptr) paint(u, v, *seen, nearest);
      }
  }
};

ColorView two_cameras() {
  ColorView view{{320, 240, 236, 236, 164, 114}, Pose::Identity()};
  view.color_from_depth.linear() =
      Eigen::AngleAxisd(0.015, Eigen::Vector3d(0.3, -0.5, 0.8).normalized()).toRotationMatrix();
  view.color_from_depth.translation() = Eigen::Vector3d(-0.04, 0.005, 0.01);
  return view;
}

std::vector<std::int64_t> all_of(const FrameSource& source) {
  std::vector<std::int64_t> all(static_cast<std::size_t>(source.size()));
  std::iota(all.begin(), all.end(), 0);
  return all;
}

ColorCalibration calibrated(const BoardSource& source) {
  return calibrate_color(source, all_of(source));
}

void expect_refused(const ColorCalibration& result, const char* words) {
  EXPECT_EQ(result.verdict, ColorCalibration::Verdict::kRefused);
  EXPECT_NE(result.message.find(words), std::string::npos) << result.message;
}

TEST(ColorCalibration, FindsAnOffsetCameraWithinAPixel) {
  BoardSource source;
  source.truth = two_cameras();
  const ColorCalibration result = calibrated(source);
  EXPECT_EQ(result.verdict, ColorCalibration::Verdict::kFound) << result.message;
  EXPECT_EQ(result.positions.size(), 12u);
  EXPECT_LT(result.found_px, 0.5 * result.given_px);
  EXPECT_LT(result.spread_px, 1);
  EXPECT_GT(result.sharpness, 0.5);
  for (const float depth_m : {1.f, 2.f, 4.f}) {
    EXPECT_GT(view_difference_px(source.depth_camera, result.given, source.truth, depth_m), 10);
    EXPECT_LT(view_difference_px(source.depth_camera, result.found, source.truth, depth_m), 0.5);
  }
}

Lens bent(double k1, double k2) {
  return {Lens::Model::kBrownConrady, {k1, k2}};
}

/// Root mean square distance over the colour image between what two lenses do to it.
double lens_difference_px(const PinholeCamera& camera, const ColorView& a, const ColorView& b) {
  return view_difference_px(camera, {a.camera, Pose::Identity(), a.lens},
                            {b.camera, Pose::Identity(), b.lens}, 2);
}

TEST(ColorCalibration, FindsALensThatWasLeftOut) {
  for (const Lens& lens : {bent(-0.3, 0.1), bent(0.12, -0.05)}) {
    BoardSource source;
    source.truth = two_cameras();
    source.truth.lens = lens;
    const ColorCalibration result = calibrated(source);
    EXPECT_EQ(result.verdict, ColorCalibration::Verdict::kFound) << result.message;
    EXPECT_EQ(result.found.lens.model, Lens::Model::kBrownConrady);
    EXPECT_NE(result.message.find("lens"), std::string::npos) << result.message;
    for (const float depth_m : {1.f, 2.f, 4.f})
      EXPECT_LT(view_difference_px(source.depth_camera, result.found, source.truth, depth_m), 0.7);
    EXPECT_GT(lens_difference_px(source.depth_camera, result.given, source.truth), 1);
  }
}

TEST(ColorCalibration, FindsALensWhereTheRestIsRight) {
  BoardSource source;
  source.truth.lens = bent(-0.2, 0.05);
  const ColorCalibration result = calibrated(source);
  EXPECT_EQ(result.verdict, ColorCalibration::Verdict::kFound) << result.message;
  EXPECT_NEAR(result.found.lens.coefficients[0], -0.2, 0.08);
  EXPECT_LT(view_difference_px(source.depth_camera, result.found, source.truth, 2), 0.7);
}

TEST(ColorCalibration, LooksForNoLensWhereOneIsKnownOrNoneIs) {
  BoardSource source;
  source.truth = two_cameras();
  EXPECT_EQ(calibrated(source).found.lens, Lens{});
  source.truth.lens = bent(-0.3, 0.1);
  source.known_lens = true;
  EXPECT_EQ(calibrated(source).found.lens, Lens{});
}

TEST(ColorCalibration, IsTheSameForAnyNumberOfThreads) {
  BoardSource source;
  source.truth = two_cameras();
  const ColorCalibration many = calibrated(source);
  const ThreadLimit limit(1);
  const ColorCalibration one = calibrated(source);
  EXPECT_EQ(one.found.camera, many.found.camera);
  EXPECT_EQ(one.found.color_from_depth.matrix(), many.found.color_from_depth.matrix());
  EXPECT_EQ(one.spread_px, many.spread_px);
}

TEST(ColorCalibration, LeavesWhatIsRightAlone) {
  BoardSource source;
  EXPECT_EQ(calibrated(source).verdict, ColorCalibration::Verdict::kAligned);
  source.truth = source.given = two_cameras();
  const ColorCalibration result = calibrated(source);
  EXPECT_EQ(result.verdict, ColorCalibration::Verdict::kAligned) << result.message;
  EXPECT_LT(view_difference_px(source.depth_camera, result.found, source.truth, 2), 0.5);
}

TEST(ColorCalibration, RefusesWhatDoesNotTell) {
  BoardSource source;
  source.truth = two_cameras();
  source.frames = 5;
  expect_refused(calibrated(source), "only 5 usable frames");
  source.frames = 12;
  source.still = true;
  expect_refused(calibrated(source), "record while the camera moves");
  source.still = false;
  source.grey = true;
  expect_refused(calibrated(source), "hardly better here");
  source.grey = false;
  source.boards.resize(1);
  expect_refused(calibrated(source), "points lie on edges of depth");
  source.boards.push_back({{-0.7, -0.5, 2}, 0.3, 0.2, {255, 0, 0}});
  ColorCalibrationConfig config;
  config.min_edges = 100;
  expect_refused(calibrate_color(source, all_of(source), config), "of 9 parts");
}

TEST(ColorCalibration, SaysHowFarItIs) {
  BoardSource source;
  source.frames = 8;
  std::size_t last = 0;
  calibrate_color(source, all_of(source), {}, [&](std::size_t done, std::size_t total) {
    EXPECT_GT(done, last);
    EXPECT_LE(done, total);
    last = done;
  });
  EXPECT_GT(last, 8u);
}

TEST(ColorCalibration, PictureShowsEdgesAsGivenAndAsFound) {
  BoardSource source;
  source.truth = two_cameras();
  const ColorCalibration result = calibrated(source);
  const RgbImage picture = calibration_picture(source, result);
  ASSERT_EQ(picture.width(), 640);
  ASSERT_EQ(picture.height(), 480);
  std::array<int, 2> red{}, green{};
  for (int y = 0; y < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x) {
      red[x >= 320] += picture.at(x, y) == Rgb8{255, 60, 40};
      green[x >= 320] += picture.at(x, y) == Rgb8{60, 255, 90};
    }
  EXPECT_GT(red[0], 500);
  EXPECT_EQ(red[1], 0);
  EXPECT_EQ(green[0], 0);
  EXPECT_GT(green[1], 500);
}

TEST(ColorCalibration, TextKeepsTheOtherKeys) {
  const fixture::TemporaryFolder folder;
  const auto file = folder.path() / "calibration.yaml";
  ColorCalibration result;
  result.depth_camera = {320, 240, 260, 260, 159.5f, 119.5f};
  result.found = two_cameras();
  write_text(file, calibrated_text(file, result));
  CameraRig rig;
  apply_calibration(file, rig);
  EXPECT_EQ(rig.depth_camera, result.depth_camera);
  EXPECT_EQ(rig.color_camera, result.found.camera);
  EXPECT_TRUE(rig.color_from_depth.isApprox(result.found.color_from_depth, 1e-5));
  EXPECT_EQ(rig.depth_units_per_m, 1000);

  write_text(file,
             "depth_camera: {fx: 300, depth_scale: 5000}\n"
             "color_camera: {fx: 7, distortion: {coefficients: [.1, 0, 0, 0, 0]}}\n"
             "poses: {direction: camera_from_world}\n");
  write_text(file, calibrated_text(file, result));
  CameraRig kept;
  apply_calibration(file, kept);
  EXPECT_EQ(kept.depth_camera.fx, 300);
  EXPECT_EQ(kept.depth_units_per_m, 5000);
  EXPECT_EQ(kept.poses.direction, PoseConvention::Direction::kCameraFromWorld);
  EXPECT_EQ(kept.color_camera, result.found.camera);
  EXPECT_EQ(kept.color_lens, (Lens{Lens::Model::kBrownConrady, {.1}}));

  result.found.lens = bent(-0.25, 0.0625);
  write_text(file, calibrated_text(file, result));
  CameraRig found;
  apply_calibration(file, found);
  EXPECT_EQ(found.color_lens, result.found.lens);

  write_text(file, "depth_camera: {fx: [\n");
  EXPECT_THROW(calibrated_text(file, result), Error);
}

TEST(ColorCalibration, ListsItsFields) {
  ColorCalibrationConfig config;
  ConfigFields fields;
  list_fields(config, fields);
  fields.set("max_frames", "30");
  fields.set("fit.starts", "3");
  fields.set("edges.jump_m", "0.1");
  EXPECT_EQ(config.max_frames, 30);
  EXPECT_EQ(config.fit.starts, 3);
  EXPECT_EQ(config.edges.jump_m, 0.1f);
}

}  // namespace
}  // namespace ovimap
