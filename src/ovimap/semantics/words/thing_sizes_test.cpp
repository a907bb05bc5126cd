// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/words/thing_sizes.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <gtest/gtest.h>

#include "ovimap/base/error.h"

namespace ovimap {
namespace {

std::vector<ThingSize> builtin_things(const std::vector<std::string>& words) {
  std::vector<ThingSize> things;
  for (const ThingSize& thing : builtin_thing_sizes())
    if (std::find(words.begin(), words.end(), thing.word) != words.end()) things.push_back(thing);
  return things;
}

std::string best_of(const ObjectMeasures& object, const std::vector<std::string>& words) {
  const std::vector<ThingSize> things = builtin_things(words);
  const std::vector<float> fits = size_likelihoods(object, things);
  return things[static_cast<std::size_t>(std::max_element(fits.begin(), fits.end()) - fits.begin())]
      .word;
}

float fit(const ObjectMeasures& object, const ThingSize& thing) {
  return size_likelihoods(object, std::span(&thing, 1)).front();
}

TEST(SizeLikelihoods, TellThingsOfDifferentSizeApart) {
  const std::vector<std::string> words{"mug", "chair", "wardrobe", "floor", "wall", "picture"};
  EXPECT_EQ(best_of({0.1f, 0.1f, 0.08f, 0.75f}, words), "mug");
  EXPECT_EQ(best_of({0.8f, 0.5f, 0.4f, 0.02f}, words), "chair");
  EXPECT_EQ(best_of({1.9f, 1.2f, 0.5f, 0.f}, words), "wardrobe");
  EXPECT_EQ(best_of({0.04f, 3.f, 3.f, 0.f}, words), "floor");
  EXPECT_EQ(best_of({2.3f, 4.f, 0.1f, 0.f}, words), "wall");
  EXPECT_EQ(best_of({0.4f, 0.5f, 0.03f, 1.4f}, words), "picture");
}

TEST(SizeLikelihoods, KnowATableByItsTopAlone) {
  const std::vector<std::string> words{"table", "place mat", "floor", "bed", "wall", "cabinet"};
  EXPECT_EQ(best_of({0.01f, 1.6f, 0.8f, 0.73f, 1.f, 0.f}, words), "table");
  EXPECT_EQ(best_of({0.01f, 0.4f, 0.3f, 0.73f, 1.f, 0.f}, words), "place mat");
}

TEST(SizeLikelihoods, TellByHowSurfaceIsSpread) {
  const std::vector<ThingSize> things =
      read_thing_sizes({}, {"table;0.7;1.4;0.8;0;0.8;0.1;3", "cabinet;0.7;1.4;0.8;0;0.2;0.8;2"});
  const auto fits = [&](float top_share, float covered_share) {
    return size_likelihoods({0.7f, 1.4f, 0.8f, 0.f, top_share, covered_share}, things);
  };
  EXPECT_GT(fits(0.7f, 0.2f)[0], 2.f * fits(0.7f, 0.2f)[1]);
  EXPECT_GT(fits(0.3f, 0.7f)[1], 2.f * fits(0.3f, 0.7f)[0]);
  EXPECT_FLOAT_EQ(fits(-1.f, -1.f)[0], fits(-1.f, -1.f)[1]);  // not known
}

TEST(SizeLikelihoods, CountWhatIsUsualAsOneWayMore) {
  const ObjectMeasures object{0.7f, 1.4f, 0.8f, 0.f};
  const std::string usual = "table;0.7;1.4;0.8;0;0", other = "table;0.01;0.1;0.1;2;1;0;1";
  const float alone = fit(object, read_thing_sizes({usual}, {}).front());
  const float unseen = fit(object, read_thing_sizes({}, {other}).front());
  const float both = fit(object, read_thing_sizes({usual}, {other}).front());
  EXPECT_NEAR(both, 0.5f * (alone + unseen), 1e-5f);
  EXPECT_GT(alone, 10.f * unseen);
}

TEST(SizeLikelihoods, ForgiveWhatWasSeenInPart) {
  const ThingSize thing{"table", {0.7f, 1.4f, 0.8f, 0.f}, 0.1f, {}};
  const float whole = fit({0.7f, 1.4f, 0.8f, 0.f}, thing);
  const float half = fit({0.7f, 0.9f, 0.8f, 0.f}, thing);
  const float twice = fit({0.7f, 2.2f, 0.8f, 0.f}, thing);
  EXPECT_GT(whole, half);
  EXPECT_GT(half, twice);
  EXPECT_GT(twice, 0.f);
  const float top = fit({0.3f, 1.4f, 0.8f, 0.4f}, thing);
  const float bottom = fit({0.3f, 1.4f, 0.8f, 0.f}, thing);
  EXPECT_GT(top, 2.f * bottom);  // tops are seen, and of things on a floor as high as ever
}

TEST(ReadThingSizes, RefusesOtherLines) {
  EXPECT_THROW(read_thing_sizes({"chair"}, {}), Error);
  EXPECT_THROW(read_thing_sizes({"chair;0.8;0.5;0.5;0.2;0.1"}, {}), Error);
  EXPECT_THROW(read_thing_sizes({}, {"chair;0.8;0.5;0.5;0;0.1;0.5"}), Error);
  EXPECT_THROW(read_thing_sizes({}, {"chair;0.8;0.5;0.5;0;0.1;0.5;0"}), Error);
}

}  // namespace
}  // namespace ovimap
