// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/search/teaching.h"

#include <gtest/gtest.h>

#include "ovimap/io/map_file/map_edits.h"
#include "ovimap/io/map_file/map_file_fixture.h"

namespace ovimap {
namespace {

class TeachingTest : public MapFolder {
 protected:
  TeachingTest() {
    save_map(map_, random_document(6, 1));
    save_map(other_, random_document(6, 2));
  }

  std::size_t rename(const std::string& name) const {
    MapEdit edit;
    edit.instances = {1};
    edit.name = name;
    edit_map(map_, edit);
    return teach(file_, map_, open_map_search(map_));
  }
  TaughtThings known_to(const std::filesystem::path& map) const {
    return taught_elsewhere(file_, map, read_map_info(map).encoder);
  }

  const std::filesystem::path map_ = root_ / "a.ovimap", other_ = root_ / "b.ovimap",
                              file_ = root_ / "taught.json";
};

TEST_F(TeachingTest, NamedObjectsTeachOtherMaps) {
  EXPECT_EQ(rename("tea pot"), 1u);
  const TaughtThings taught = known_to(other_);
  ASSERT_EQ(taught.names, std::vector<std::string>{"tea pot"});
  const MapSearch search = open_map_search(map_);
  EXPECT_GT(taught.looks.row(0).dot(search.index.embeddings().row(0)), 0.99f);
  EXPECT_TRUE(known_to(map_).names.empty()) << "a map knows its own names";
}

TEST_F(TeachingTest, WhatIsTakenBackIsForgotten) {
  rename("tea pot");
  rename("kettle");
  EXPECT_EQ(known_to(other_).names, std::vector<std::string>{"kettle"});
  EXPECT_EQ(rename(""), 0u);
  EXPECT_TRUE(known_to(other_).names.empty());
}

TEST_F(TeachingTest, OtherEncodersSeeThingsOtherwise) {
  rename("tea pot");
  EncoderIdentity encoder = read_map_info(other_).encoder;
  encoder.digest += "0";
  EXPECT_TRUE(taught_elsewhere(file_, other_, encoder).names.empty());
}

TEST_F(TeachingTest, WithoutAFileNothingIsTaught) {
  EXPECT_TRUE(taught_elsewhere("", other_, {}).names.empty());
  EXPECT_TRUE(known_to(other_).names.empty());
}

/// However a map is named, it is one map.
TEST_F(TeachingTest, KnowsAMapByItsFile) {
  rename("tea pot");
  teach(file_, root_ / "x" / ".." / "a.ovimap", open_map_search(map_));
  EXPECT_EQ(known_to(other_).names.size(), 1u);
}

}  // namespace
}  // namespace ovimap
