// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/classes/name_search.h"

#include <gtest/gtest.h>

namespace ovimap {
namespace {

/// Nothing but names is known of them.
SearchIndex named_things() {
  std::vector<SearchObject> objects(4);
  const char* const names[] = {"red tea pot", "", "Pot", "potted plant"};
  for (std::size_t i = 0; i < objects.size(); ++i) {
    objects[i].id = static_cast<InstanceId>(10 + i);
    objects[i].name = names[i];
  }
  return SearchIndex(objects, Embeddings::Zero(4, 0));
}

std::vector<InstanceId> ids(const QueryAnswer& answer) {
  std::vector<InstanceId> found;
  for (const QueryMatch& match : answer.matches) found.push_back(match.id);
  return found;
}

TEST(FindByName, FindsWholeWordsOfNamesTheShortestFirst) {
  const SearchIndex index = named_things();
  const QueryAnswer answer = find_by_name(index, {"pot", {}, true});
  EXPECT_EQ(answer.verdict, Verdict::kFound);
  EXPECT_EQ(ids(answer), (std::vector<InstanceId>{12, 10}));
  EXPECT_EQ(answer.relevance, Eigen::Vector4f(1, 0, 1, 0));
  EXPECT_EQ(ids(find_by_name(index, {"Tea Pot, plant", {}})), (std::vector<InstanceId>{10, 13}));
  EXPECT_EQ(ids(find_by_name(index, {"pot", {"tea"}})), (std::vector<InstanceId>{12}));
  EXPECT_EQ(ids(find_by_name(index, {"pot", {}, false, {true, true, false, true}})),
            (std::vector<InstanceId>{10}));
}

TEST(FindByName, NothingElseIsFound) {
  for (const char* text : {"plan", "", "te", "red  pot"}) {
    const QueryAnswer answer = find_by_name(named_things(), {text, {}});
    EXPECT_EQ(answer.verdict, Verdict::kNotInMap) << text;
    EXPECT_TRUE(answer.matches.empty()) << text;
  }
}

}  // namespace
}  // namespace ovimap
