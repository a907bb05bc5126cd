// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/things/thing_detector.h"

#include <cmath>

#include <gtest/gtest.h>

#include "ovimap/inference/models/test_support.h"

namespace ovimap {
namespace {

Eigen::AlignedBox2f box(float left, float top, float right, float bottom) {
  return {Eigen::Vector2f(left, top), Eigen::Vector2f(right, bottom)};
}

TEST(ScoreRatio, IsMeasuredAgainstTheBackground) {
  const ScoreRatio ratio{0.03f, 2.f, -1.f};
  EXPECT_FLOAT_EQ(ratio.log_ratio(0.1f, 0.1f), -1.f);
  EXPECT_GT(ratio.log_ratio(0.5f, 0.02f), ratio.log_ratio(0.5f, 0.1f));
  EXPECT_TRUE(std::isfinite(ratio.log_ratio(0.f, 0.f)));
}

/// The golden detector tells red, green and blue in the four quarters of a picture.
class GoldenDetector : public ::testing::Test {
 protected:
  GoldenDetector() : model_(read_model_folder(inference_testdata() / "golden_detector")) {
    fill_box(picture_, 0, 0, 80, 60, {255, 0, 0});
    fill_box(picture_, 80, 60, 160, 120, {0, 0, 255});
  }
  ModelFolder model_;
  RgbImage picture_{160, 120, {0, 0, 0}};
};

TEST_F(GoldenDetector, TellsWhatIsInABox) {
  const ThingDetector detector(model_, {});
  EXPECT_EQ(detector.things(), (std::vector<std::string>{"red", "green|lime", "blue"}));
  const auto found = detector.find(picture_);
  const Eigen::VectorXf first = detector.log_ratios(found, box(0, 0, 0.5f, 0.5f));
  const Eigen::VectorXf last = detector.log_ratios(found, box(0.5f, 0.5f, 1, 1));
  ASSERT_EQ(first.size(), 3);
  EXPECT_GT(first[0], 1.f);
  EXPECT_LT(first[1], 0.f);
  EXPECT_LT(first[2], 0.f);
  EXPECT_GT(last[2], 1.f);
  EXPECT_LT(last[0], 0.f);
}

TEST_F(GoldenDetector, WhatOverlapsLittleSaysNothing) {
  const ThingDetector detector(model_, {});
  const auto found = detector.find(picture_);
  EXPECT_LT(detector.log_ratios(found, box(0, 0, 0.2f, 0.2f)).maxCoeff(), 0.f);
  EXPECT_LT(detector.log_ratios(found, box(0, 0, 1, 1)).maxCoeff(), 0.f);
}

TEST_F(GoldenDetector, RefusesWhatDoesNotFit) {
  const auto fault = [&](const ModelFolder& model) {
    return error_of([&] { ThingDetector(model, {}); });
  };
  ModelFolder model = model_;
  model.kind = "writing";
  EXPECT_NE(fault(model).find("kind detector"), std::string::npos);
  model = model_;
  model.extras["names"] = "red;0.1\nblue;0.1";
  EXPECT_NE(fault(model).find("names 2 things"), std::string::npos) << fault(model);
  model.extras["names"] = "red;0.1\nblue";
  EXPECT_NE(fault(model).find("words;background"), std::string::npos);
  model.extras["names"] = "red;0.1\nblue;2\ngreen;0.1";
  EXPECT_NE(fault(model).find("background of blue"), std::string::npos);
  model = model_;
  model.extras.erase("slope");
  EXPECT_NE(fault(model).find("'slope'"), std::string::npos);
}

TEST_F(GoldenDetector, SeveralDetectorsAnswerOneAfterTheOther) {
  const std::string folder = (inference_testdata() / "golden_detector").string();
  const auto recognizer = make_thing_recognizer(folder + "," + folder, {});
  ASSERT_NE(recognizer, nullptr);
  EXPECT_EQ(recognizer->identity().things.size(), 6u);
  const Eigen::VectorXf ratios = recognizer->look(picture_)->log_ratios(box(0, 0, 0.5f, 0.5f));
  ASSERT_EQ(ratios.size(), 6);
  EXPECT_EQ(ratios.head(3), ratios.tail(3));
}

TEST(MakeThingRecognizer, NoneIsNone) {
  EXPECT_EQ(make_thing_recognizer("none", {}), nullptr);
  EXPECT_THROW(make_thing_recognizer("no-such-detector", {}), Error);
}

}  // namespace
}  // namespace ovimap
