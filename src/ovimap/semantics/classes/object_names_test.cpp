// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/classes/object_names.h"

#include <gtest/gtest.h>

#include "ovimap/semantics/query/query_engine.h"
#include "ovimap/semantics/query/query_fixture.h"

namespace ovimap {
namespace {

std::vector<ObjectName> names_of(const std::vector<std::string>& things,
                                 const QueryConfig& config) {
  WordEncoder encoder;
  const SearchIndex index = map_of(things);
  const TextMatcher matcher(index, encoder, config, {});
  return name_objects(*matcher.evidence());
}

TEST(NameObjects, SaysWhatIsClearAndNothingElse) {
  const auto names = names_of({"mug", "desk", "keyboard", "zeppelin hangar"}, {});
  EXPECT_EQ(names[0].word, "mug");
  EXPECT_EQ(names[1].word, "desk");
  EXPECT_EQ(names[2].word, "keyboard");
  EXPECT_EQ(names[3].word, ObjectName::kUnclear);
  EXPECT_FALSE(names[3].clear());
  EXPECT_TRUE(names[0].clear());
}

/// Rather a sofa or an armchair than anything else: a seat.
TEST(NameObjects, TakesAWiderWordWhereSeveralAreNear) {
  QueryConfig config;
  config.evidence.name_share = 0.6f;
  const auto names = names_of({"sofa armchair stool", "mug", "lamp", "door"}, config);
  EXPECT_EQ(names[0].word, "seat");
}

}  // namespace
}  // namespace ovimap
