// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/recording/gyroscope.h"

#include <gtest/gtest.h>

#include "ovimap/base/error_fixture.h"
#include "ovimap/frames/frame/frame_source.h"
#include "ovimap/frames/recording/sequence_fixture.h"

namespace ovimap {
namespace {

double angle_rad(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  return a.angularDistance(b);
}

/// A camera that turns to and fro about two axes at once, so that turns do not commute.
Eigen::Quaterniond orientation(double t) {
  return Eigen::AngleAxisd(0.8 * std::sin(2 * t), Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(0.5 * std::sin(3 * t), Eigen::Vector3d::UnitX());
}

Eigen::Vector3d rate(double t) {
  constexpr double kStep_s = 1e-4;
  const Eigen::AngleAxisd turn(orientation(t - kStep_s).inverse() * orientation(t + kStep_s));
  return turn.angle() * turn.axis() / (2 * kStep_s);
}

std::vector<TurnRate> samples(double seconds, double rate_hz) {
  std::vector<TurnRate> samples;
  for (int i = 0; i <= std::lround(seconds * rate_hz); ++i)
    samples.push_back({i / rate_hz, rate(i / rate_hz)});
  return samples;
}

TEST(OrientationTimeline, AddsTurnsUpAlsoBetweenSamples) {
  const OrientationTimeline timeline(samples(3, 200));
  for (const double t : {0.0, 0.5, 1.2345, 2.9999})
    EXPECT_LT(angle_rad(*timeline.at(t), orientation(t)), 2e-4) << t;
}

TEST(OrientationTimeline, SaysNothingWhereThereAreNoSamples) {
  std::vector<TurnRate> rates = samples(1, 100);
  std::erase_if(rates, [](const TurnRate& r) { return r.time_s > 0.4 && r.time_s < 0.6; });
  const OrientationTimeline timeline(rates);
  EXPECT_FALSE(timeline.at(-0.001));
  EXPECT_FALSE(timeline.at(1.001));
  EXPECT_FALSE(timeline.at(0.5));
  EXPECT_TRUE(timeline.at(0.4));
  EXPECT_TRUE(timeline.at(0.7));
  EXPECT_FALSE(OrientationTimeline({}).at(0));
}

class GyroscopeFile : public testing::Test {
 protected:
  GyroscopeFile() { fixture::write_tum(folder_.path(), sequence_); }
  std::string error(const std::string& text) const {
    write_text(file_, text);
    return error_of([&] { read_gyroscope(file_); });
  }

  fixture::TemporaryFolder folder_;
  fixture::Sequence sequence_;
  std::filesystem::path file_ = folder_.path() / kGyroscopeFile;
};

/// What is written is read, and a frame takes what was at the time of its depth, 10 ms after its
/// colour.
TEST_F(GyroscopeFile, IsReadWithARecording) {
  constexpr double kStart_s = 1305031102;
  std::vector<TurnRate> rates = samples(1, 200);
  for (TurnRate& rate : rates) rate.time_s += kStart_s;
  write_text(file_, gyroscope_text(rates));
  const auto source = open_frame_source(folder_.path());
  const FrameRead first = source->read(0), later = source->read(5);
  ASSERT_TRUE(first.frame && first.frame->orientation && later.frame && later.frame->orientation);
  EXPECT_LT(angle_rad(*first.frame->orientation, orientation(0.110)), 1e-3);
  EXPECT_LT(angle_rad(*later.frame->orientation, orientation(0.110 + 5 * 0.033)), 1e-3);
  EXPECT_GT(angle_rad(orientation(0.110), orientation(0.100)), 1e-2);  // the test tells them apart
}

TEST_F(GyroscopeFile, ARecordingWithoutOneHasNoOrientations) {
  EXPECT_FALSE(open_frame_source(folder_.path())->read(0).frame->orientation);
}

TEST_F(GyroscopeFile, SaysWhatIsWrongWithALine) {
  EXPECT_NE(error("# t\n1 0 0 0\n2 0 0\n").find("line 3 is '2 0 0'; expected a time"),
            std::string::npos);
  EXPECT_NE(error("1 0 0 x\n").find("line 1"), std::string::npos);
  EXPECT_NE(error("1 0 90 0\n").find("are they degrees?"), std::string::npos);
  EXPECT_NE(error("1 0 nan 0\n").find("line 1 turns by"), std::string::npos);
}

TEST_F(GyroscopeFile, LinesMayComeInAnyOrder) {
  write_text(file_, "3 0 0 3\n1 0 0 1\n2 0 0 2\n");
  const auto rates = read_gyroscope(file_);
  ASSERT_EQ(rates.size(), 3u);
  EXPECT_EQ(rates[0].rad_per_s.z(), 1);
  EXPECT_EQ(rates[2].time_s, 3);
}

}  // namespace
}  // namespace ovimap
