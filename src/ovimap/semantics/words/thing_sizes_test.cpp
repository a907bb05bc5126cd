// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/words/thing_sizes.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "ovimap/base/error.h"
#include "ovimap/semantics/words/word_lists.h"

namespace ovimap {
namespace {

std::string best_of(const ObjectMeasures& object, const std::vector<std::string>& words) {
  const auto things = read_thing_sizes(list_entries(builtin_word_list("thing_sizes")));
  std::string best;
  float most = 0.f;
  for (const ThingSize& thing : things) {
    if (std::find(words.begin(), words.end(), thing.word) == words.end()) continue;
    const float likelihood = size_likelihood(object, thing);
    if (likelihood > most) best = thing.word;
    most = std::max(most, likelihood);
  }
  return best;
}

TEST(SizeLikelihood, TellsThingsOfDifferentSizeApart) {
  const std::vector<std::string> words{"mug", "chair", "wardrobe", "floor", "wall", "picture"};
  EXPECT_EQ(best_of({0.1f, 0.1f, 0.08f, 0.75f}, words), "mug");
  EXPECT_EQ(best_of({0.8f, 0.5f, 0.4f, 0.02f}, words), "chair");
  EXPECT_EQ(best_of({1.9f, 1.2f, 0.5f, 0.f}, words), "wardrobe");
  EXPECT_EQ(best_of({0.04f, 3.f, 3.f, 0.f}, words), "floor");
  EXPECT_EQ(best_of({2.3f, 4.f, 0.1f, 0.f}, words), "wall");
  EXPECT_EQ(best_of({0.4f, 0.5f, 0.03f, 1.4f}, words), "picture");
}

TEST(SizeLikelihood, ForgivesWhatWasSeenInPart) {
  const ThingSize thing{"table", {0.7f, 1.4f, 0.8f, 0.f}, 0.1f};
  const float whole = size_likelihood({0.7f, 1.4f, 0.8f, 0.f}, thing);
  const float half = size_likelihood({0.7f, 0.9f, 0.8f, 0.f}, thing);
  const float twice = size_likelihood({0.7f, 2.2f, 0.8f, 0.f}, thing);
  EXPECT_GT(whole, half);
  EXPECT_GT(half, twice);
  EXPECT_GT(twice, 0.f);
}

TEST(MeasureObjects, MeasuresAlongTheObjectsOwnSides) {
  ObjectShape shape;  // 2 m by 1 m, turned by 45 degrees
  const float s = std::sqrt(0.5f);
  shape.footprint = {{0.f, 0.f}, {2 * s, 2 * s}, {s, 3 * s}, {-s, s}};
  shape.bottom_m = 1.f;
  shape.top_m = 1.5f;
  ObjectShape floor;
  floor.footprint = {{0.f, 0.f}, {5.f, 0.f}, {5.f, 5.f}};
  floor.bottom_m = floor.top_m = 0.3f;
  const std::vector<ObjectShape> shapes{shape, floor};
  const ObjectMeasures found = measure_objects(shapes)[0];
  EXPECT_NEAR(found.length_m, 2.f, 1e-5f);
  EXPECT_NEAR(found.depth_m, 1.f, 1e-5f);
  EXPECT_NEAR(found.height_m, 0.5f, 1e-6f);
  EXPECT_NEAR(found.bottom_m, 0.7f, 1e-6f);
  EXPECT_TRUE(measure_objects({}).empty());
}

TEST(ReadThingSizes, RefusesOtherLines) {
  EXPECT_THROW(read_thing_sizes({"chair"}), Error);
  EXPECT_THROW(read_thing_sizes({"chair;0.8;0.5;0.5;0.2;0.1"}), Error);
}

}  // namespace
}  // namespace ovimap
