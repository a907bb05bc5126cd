// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/search/name_guesses.h"

#include <gtest/gtest.h>

#include "ovimap/base/error.h"
#include "ovimap/semantics/views/color_encoder_fixture.h"

namespace ovimap {
namespace {

const LabelSet kColors = {"colours", {{1, "red"}, {2, "green"}, {3, "blue"}}};

/// Object 4 is red, object 7 has no embedding.
MapRecord red_map() {
  MapRecord map;
  map.semantics.encoder = ColorEncoder().identity();
  for (const InstanceId id : {4u, 7u}) {
    InstanceSummary instance;
    instance.id = id;
    instance.super_points = {id};
    map.instances.push_back(instance);
  }
  ObjectView view;
  view.visible_px = 10;
  view.embedding = Eigen::Vector3f(0.8f, 0.f, 0.6f);
  map.semantics.looks[4].views = {view};
  map.semantics.looks[7].views = {ObjectView()};
  return map;
}

TEST(GuessNames, GivesTheNearestNamesBestFirst) {
  ColorEncoder encoder;
  const NameGuesses guesses = guess_names(red_map(), encoder, kColors, 2);
  ASSERT_EQ(guesses.size(), 1u);
  const std::vector<NameGuess>& best = guesses.at(4);
  ASSERT_EQ(best.size(), 2u);
  EXPECT_EQ(best[0].name, "red");
  EXPECT_NEAR(best[0].cosine, 0.8f, 1e-6f);
  EXPECT_EQ(best[1].name, "blue");
  EXPECT_NEAR(best[1].cosine, 0.6f, 1e-6f);
}

TEST(GuessNames, RefusesAnotherEncoder) {
  ColorEncoder encoder;
  MapRecord map = red_map();
  map.semantics.encoder.digest = std::string(64, 'd');
  EXPECT_THROW(guess_names(map, encoder, kColors, 2), Error);
  map.semantics.encoder.name = "words";
  EXPECT_THROW(guess_names(map, encoder, kColors, 2), Error);
}

TEST(HasEmbeddings, LooksAtListedInstancesOnly) {
  MapRecord map = red_map();
  EXPECT_TRUE(has_embeddings(map));
  map.instances.erase(map.instances.begin());
  EXPECT_FALSE(has_embeddings(map));
  EXPECT_FALSE(has_embeddings({}));
}

}  // namespace
}  // namespace ovimap
