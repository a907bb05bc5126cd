// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/things/person_finder.h"

#include <gtest/gtest.h>

#include "ovimap/inference/models/test_support.h"

namespace ovimap {
namespace {

/// The golden detector, which takes red for a person. It looks at the four quarters of a picture.
ModelFolder red_people() {
  ModelFolder model = read_model_folder(inference_testdata() / "golden_detector");
  model.extras["names"] = "man|person;0.05\ngreen;0.05\nblue;0.05";
  return model;
}

TEST(PersonFinder, FindsBoxesOfPeople) {
  const PersonFinder finder(red_people(), {});
  RgbImage picture(160, 160, {0, 0, 0});
  EXPECT_TRUE(finder.find(picture, 0.5f).empty());
  fill_box(picture, 0, 0, 80, 80, {255, 0, 0});
  fill_box(picture, 80, 80, 160, 160, {0, 0, 255});
  const auto people = finder.find(picture, 0.5f);
  ASSERT_EQ(people.size(), 1u);
  EXPECT_GT(people[0].score, 0.5f);
  EXPECT_NEAR(people[0].in_image_px.min().x(), -0.5f, 1e-3f);
  EXPECT_NEAR(people[0].in_image_px.max().x(), 79.5f, 1e-3f);
  EXPECT_NEAR(people[0].in_image_px.max().y(), 79.5f, 1e-3f);
  fill_box(picture, 80, 80, 160, 160, {200, 0, 0});
  EXPECT_EQ(finder.find(picture, 0.5f).size(), 2u);
  EXPECT_TRUE(finder.find(picture, 1.01f).empty());
}

TEST(PersonFinder, LooksAtTheSquaresAtBothEndsAsWell) {
  const PersonFinder finder(red_people(), {});
  RgbImage wide(320, 80, {0, 0, 0});
  fill_box(wide, 280, 40, 320, 80, {255, 0, 0});  // a quarter of a quarter of the whole
  const auto people = finder.find(wide, 0.5f);
  ASSERT_EQ(people.size(), 1u);
  EXPECT_NEAR(people[0].in_image_px.min().x(), 279.5f, 1e-3f);
  EXPECT_NEAR(people[0].in_image_px.max().y(), 79.5f, 1e-3f);
}

TEST(PersonFinder, ADetectorWithoutPeopleIsRefused) {
  const auto model = read_model_folder(inference_testdata() / "golden_detector");
  EXPECT_TRUE(contains(error_of([&] { PersonFinder finder(model, {}); }),
                       "knows no thing called 'person'"));
  const std::string absent = error_of([] { make_person_finder("no-such-detector", {}); });
  EXPECT_TRUE(contains(absent, "'no-such-detector', which is not installed")) << absent;
  EXPECT_TRUE(contains(absent, "tools/setup.sh")) << absent;
}

}  // namespace
}  // namespace ovimap
