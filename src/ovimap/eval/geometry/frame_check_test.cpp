// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/eval/geometry/frame_check.h"

#include <functional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace ovimap {
namespace {

using Points = std::vector<Eigen::Vector3f>;

/// Floor, two walls and a block of a room that looks different from every side; 4 x 3 x 2.5 m.
Points room() {
  Points points;
  const auto add_patch = [&](Eigen::Vector3f at, Eigen::Vector3f a, Eigen::Vector3f b) {
    for (int i = 0; i <= 40; ++i)
      for (int k = 0; k <= 40; ++k)
        points.emplace_back(at + a * (static_cast<float>(i) / 40) +
                            b * (static_cast<float>(k) / 40));
  };
  add_patch({1, 2, 0}, {4, 0, 0}, {0, 3, 0});
  add_patch({1, 2, 0}, {4, 0, 0}, {0, 0, 2.5f});
  add_patch({1, 2, 0}, {0, 3, 0}, {0, 0, 2.5f});
  add_patch({3, 3, 0.7f}, {1.2f, 0, 0}, {0, 0.6f, 0});
  add_patch({3, 3, 0}, {1.2f, 0, 0}, {0, 0, 0.7f});
  return points;
}

Points moved(const Points& points, const std::function<Eigen::Vector3f(Eigen::Vector3f)>& by) {
  Points result;
  for (const Eigen::Vector3f& point : points) result.push_back(by(point));
  return result;
}

void expect_named(const FrameCheck& check, std::initializer_list<const char*> words) {
  for (const char* word : words)
    EXPECT_NE(check.fault.find(word), std::string::npos) << word << ": " << check.fault;
}

TEST(FrameCheck, PassesWhatFits) {
  const FrameCheck check = check_frames(room(), room());
  EXPECT_EQ(check.share, 1);
  EXPECT_EQ(check.fault, "");
}

TEST(FrameCheck, PassesIncompleteAndNoisyMaps) {
  Points some = room();
  some.resize(some.size() / 20);  // a strip of the floor
  EXPECT_EQ(check_frames(room(), some).fault, "");
  std::mt19937 random(1);
  std::normal_distribution<float> noise(0, 0.1f);
  const Points bad = moved(room(), [&](Eigen::Vector3f p) {
    return Eigen::Vector3f(p + Eigen::Vector3f(noise(random), noise(random), noise(random)));
  });
  const FrameCheck check = check_frames(room(), bad);
  EXPECT_LT(check.share, 0.5);
  EXPECT_EQ(check.fault, "");
}

TEST(FrameCheck, NamesTheScale) {
  const auto scaled = [](float scale) {
    return moved(room(), [&](Eigen::Vector3f p) { return Eigen::Vector3f(scale * p); });
  };
  expect_named(check_frames(scaled(1000), room()), {"1000 times", "metres"});
  expect_named(check_frames(room(), scaled(1000)), {"0.001 times"});
  expect_named(check_frames(scaled(100), room()), {"the truth's numbers are 100 times"});
}

TEST(FrameCheck, NamesTheAxes) {
  // y up instead of z up: the truth is (x, z, -y) of the map.
  const Points y_up =
      moved(room(), [](Eigen::Vector3f p) { return Eigen::Vector3f(p.x(), p.z(), -p.y()); });
  const FrameCheck check = check_frames(y_up, room());
  expect_named(check, {"x, y, z are the map's x, z, -y"});
  EXPECT_EQ(check.fault.find("times"), std::string::npos) << check.fault;
  EXPECT_EQ(check.fault.find("origin"), std::string::npos) << check.fault;
}

TEST(FrameCheck, NamesTheOrigin) {
  const Points away = moved(
      room(), [](Eigen::Vector3f p) { return Eigen::Vector3f(p + Eigen::Vector3f(50, 0, -3)); });
  expect_named(check_frames(away, room()), {"origin", "(50, 0, -3)"});
}

TEST(FrameCheck, SaysWhenNothingFits) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> far(500, 600);
  Points cloud;
  for (int i = 0; i < 500; ++i) cloud.emplace_back(far(random), far(random), far(random));
  const FrameCheck check = check_frames(room(), cloud);
  EXPECT_EQ(check.share, 0);
  expect_named(check, {"do not overlap", "(1, 2, 0) to (5, 5, 2.5)"});
}

}  // namespace
}  // namespace ovimap
