// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/live/camera_feed.h"

#include <atomic>

#include <gtest/gtest.h>

namespace ovimap {
namespace {

using std::chrono::milliseconds;

/// Sends so many frames, then is silent, or gone.
class StubCamera : public RgbdCamera {
 public:
  StubCamera(int frames, std::string fault) : left_(frames), fault_(std::move(fault)) {}

  const std::string& name() const override { return name_; }
  bool registered() const override { return true; }
  double depth_units_per_m() const override { return 1000; }
  CameraRead next(milliseconds) override {
    if (left_-- <= 0) return {{}, fault_};
    Frame frame;
    frame.depth_camera.width = width;
    return {std::move(frame), {}};
  }
  int width = 640;

 private:
  const std::string name_ = "stub";
  std::atomic<int> left_;
  const std::string fault_;
};

/// All that comes until the intake ends.
int frames_of(FrameIntake& intake) {
  int frames = 0;
  while (!intake.ended()) frames += intake.next(milliseconds(10)).has_value();
  return frames;
}

TEST(CameraFeed, ACameraThatIsGoneEndsTheIntake) {
  StubCamera camera(5, "was unplugged");
  FrameIntake intake(8);
  CameraFeed feed(camera, intake);
  feed.start();
  EXPECT_EQ(frames_of(intake), 5);
  feed.stop();
  EXPECT_EQ(feed.fault(), "was unplugged");
}

TEST(CameraFeed, SoDoesOneThatIsSilent) {
  StubCamera camera(2, "");
  FrameIntake intake(8);
  CameraFeed feed(camera, intake, milliseconds(20));
  feed.start();
  EXPECT_EQ(frames_of(intake), 2);
  feed.stop();
  EXPECT_NE(feed.fault().find("has sent no image for"), std::string::npos);
}

TEST(CameraFeed, AnIntakeThatEndsEndsTheFeedWithoutFault) {
  StubCamera camera(1 << 30, "");
  FrameIntake intake(2);
  CameraFeed feed(camera, intake);
  feed.start();
  EXPECT_TRUE(intake.next(milliseconds(10000)));
  intake.finish();
  feed.stop();
  EXPECT_EQ(feed.fault(), "");
}

TEST(CameraFeed, AnotherCameraThanTheMapsIsAFault) {
  StubCamera camera(5, "");
  FrameIntake intake(2);
  PinholeCamera other;
  other.width = 320;
  intake.resume_at(7, other);
  CameraFeed feed(camera, intake);
  feed.start();
  EXPECT_EQ(frames_of(intake), 0);
  feed.stop();
  EXPECT_NE(feed.fault().find("another calibration"), std::string::npos);
}

}  // namespace
}  // namespace ovimap
