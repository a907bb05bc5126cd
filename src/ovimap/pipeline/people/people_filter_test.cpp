// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/people/people_filter.h"

#include <gtest/gtest.h>

#include "ovimap/inference/models/test_support.h"
#include "ovimap/pipeline/people/peopleless_source.h"

namespace ovimap {
namespace {

/// The golden detector, which takes red in a quarter of the picture for a person.
std::shared_ptr<const PersonFinder> red_people() {
  ModelFolder model = read_model_folder(inference_testdata() / "golden_detector");
  model.extras["names"] = "person;0.05\ngreen;0.05\nblue;0.05";
  return std::make_shared<PersonFinder>(model, RuntimeConfig{});
}

/// A wall 3 m away, and somebody red in the first quarter, 1.5 m away.
Frame frame_with(bool somebody, std::int64_t index = 0) {
  Frame frame;
  frame.index = index;
  frame.name = "f";
  frame.depth_camera = frame.color_camera = {160, 120, 150.f, 150.f, 79.5f, 59.5f};
  frame.color = RgbImage(160, 120, {0, 10, 20});
  frame.depth = DepthImage(160, 120, 3.f);
  for (int v = 0; somebody && v < 60; ++v)
    for (int u = 0; u < 80; ++u) frame.color.at(u, v) = {255, 0, 0}, frame.depth.at(u, v) = 1.5f;
  return frame;
}

class TwoFrames : public FrameSource {
 public:
  std::string kind() const override { return "two"; }
  std::int64_t size() const override { return 2; }
  FrameRead read(std::int64_t position) const override {
    return {frame_with(position == 1, position), {}};
  }
};

TEST(PeopleFilter, LeavesNeitherDepthNorColourOfPeople) {
  const PeopleFilter filter({}, red_people());
  const auto frame = filter.without_people(frame_with(true)).frame;
  ASSERT_TRUE(frame);
  EXPECT_EQ(std::count(frame->depth.begin(), frame->depth.end(), 1.5f), 0);
  for (const Rgb8& pixel : frame->color) EXPECT_LT(pixel.r, 255);
  EXPECT_EQ(frame->color.at(40, 30), Rgb8{});
  EXPECT_EQ(frame->depth.at(120, 90), 3.f) << "the wall stays";
  EXPECT_EQ(frame->color.at(120, 90), (Rgb8{0, 10, 20}));
  EXPECT_EQ(frame->depth.at(81, 30), 0.f) << "the edge, whose depth may mix both";
  EXPECT_EQ(frame->taken_out.at(40, 30), 1.5f) << "how far away they were, for what moves";
  EXPECT_EQ(frame->taken_out.at(120, 90), 0.f);
}

TEST(PeopleFilter, AFrameOfNobodyStaysAsItIs) {
  const PeopleFilter filter({}, red_people());
  const auto frame = filter.without_people(frame_with(false)).frame;
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->color, frame_with(false).color);
  EXPECT_EQ(frame->depth, frame_with(false).depth);
  EXPECT_TRUE(frame->taken_out.empty());
  EXPECT_EQ(filter.frames_with_people(), 0u);
}

TEST(PeopleFilter, CountsEachFrameOnce) {
  const PeopleFilter filter({}, red_people());
  for (const std::int64_t index : {3, 3, 4}) filter.without_people(frame_with(true, index));
  filter.without_people(frame_with(false, 5));
  EXPECT_EQ(filter.frames_with_people(), 2u);
}

TEST(PeopleFilter, NothingIsLeftOfAFrameThatShowsPeopleAlone) {
  const PeopleFilter filter({}, red_people());
  Frame frame = frame_with(true);
  for (int v = 0; v < 120; ++v)
    for (int u = 0; u < 160; ++u)
      if (u >= 80 || v >= 60) frame.depth.at(u, v) = 0;
  const FrameRead left = filter.without_people(std::move(frame));
  EXPECT_FALSE(left.frame);
  EXPECT_EQ(left.fault, "f: shows nothing but people");
}

TEST(PeoplelessSource, GivesTheFramesWithoutPeople) {
  const auto filter = std::make_shared<const PeopleFilter>(PeopleConfig{}, red_people());
  const PeoplelessSource source(std::make_unique<TwoFrames>(), filter);
  EXPECT_EQ(source.size(), 2);
  EXPECT_EQ(source.read(0).frame->depth.at(40, 30), 3.f);
  EXPECT_EQ(source.read(1).frame->depth.at(40, 30), 0.f);
  EXPECT_EQ(filter->frames_with_people(), 1u);
}

}  // namespace
}  // namespace ovimap
