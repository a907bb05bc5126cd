// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/surface/levels_file.h"

#include <fstream>

#include "ovimap/io/map_file/map_file_fixture.h"

namespace ovimap {
namespace {

class LevelsFileTest : public MapFolder {
 protected:
  static MadeChunks chunks() {
    MadeChunk first;
    first.index = {1, -2, 300};
    first.totals = {ChunkTotals{1, 20, 30}, {1, 5, 6}, {1, 3, 1}};
    first.coarse = {std::make_shared<std::string>("few\0\xff", 5),
                    std::make_shared<std::string>("very few")};
    first.errors = {{7, 9}, {~std::uint64_t{0}, 255}};
    MadeChunk second = first;
    second.index = {0, 0, 0};
    second.errors.clear();
    return {std::make_shared<MadeChunk>(first), std::make_shared<MadeChunk>(second)};
  }

  const std::filesystem::path file_ = levels_file(root_, 77);
};

TEST_F(LevelsFileTest, IsReadAsItWasWritten) {
  write_levels(file_, chunks());
  const MadeChunks read = read_levels(file_);
  ASSERT_EQ(read.size(), 2u);
  EXPECT_EQ(read[0]->index, Eigen::Vector3i(1, -2, 300));
  EXPECT_EQ(read[0]->totals[1].triangles, 6u);
  EXPECT_EQ(*read[0]->coarse[0], std::string("few\0\xff", 5));
  EXPECT_EQ(*read[0]->coarse[1], "very few");
  EXPECT_EQ(read[0]->errors, chunks()[0]->errors);
  EXPECT_TRUE(read[1]->errors.empty());
}

TEST_F(LevelsFileTest, IsDoneWithoutWhenItIsNotSound) {
  EXPECT_TRUE(read_levels(file_).empty());
  EXPECT_TRUE(levels_file({}, 77).empty());
  write_levels(file_, chunks());
  std::fstream(file_, std::ios::in | std::ios::out | std::ios::binary).seekp(40) << 'x';
  EXPECT_TRUE(read_levels(file_).empty());
  std::ofstream(file_) << "odd";
  EXPECT_TRUE(read_levels(file_).empty());
}

TEST_F(LevelsFileTest, FewAreKept) {
  for (std::uint64_t hash = 0; hash < 20; ++hash) write_levels(levels_file(root_, hash), chunks());
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(root_ / "surfaces"), {}), 16);
}

}  // namespace
}  // namespace ovimap
