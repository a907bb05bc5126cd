// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/frame/frame_source.h"

#include <gtest/gtest.h>

#include "ovimap/base/config.h"
#include "ovimap/frames/recording/sequence_fixture.h"

namespace ovimap {
namespace {

using Positions = std::vector<std::int64_t>;

TEST(FrameRange, EachPartMayBeLeftOut) {
  EXPECT_EQ(positions(parse_frame_range("2:9:3"), 100), (Positions{2, 5, 8}));
  EXPECT_EQ(positions(parse_frame_range("7:"), 10), (Positions{7, 8, 9}));
  EXPECT_EQ(positions(parse_frame_range(":3"), 10), (Positions{0, 1, 2}));
  EXPECT_EQ(positions(parse_frame_range("::4"), 10), (Positions{0, 4, 8}));
  EXPECT_EQ(positions(parse_frame_range("1::4"), 10), (Positions{1, 5, 9}));
  EXPECT_EQ(positions(parse_frame_range(":"), 3), (Positions{0, 1, 2}));
  EXPECT_EQ(positions({}, 2), (Positions{0, 1}));
}

TEST(FrameRange, StopsAtTheEndOfTheSource) {
  EXPECT_EQ(positions(parse_frame_range("8:200"), 10), (Positions{8, 9}));
  EXPECT_EQ(positions(parse_frame_range("20:"), 10), Positions{});
  EXPECT_EQ(positions(parse_frame_range("5:5"), 10), Positions{});
  EXPECT_EQ(positions(parse_frame_range("::9223372036854775807"), 10), Positions{0});
  EXPECT_EQ(positions({}, 0), Positions{});
}

TEST(FrameRange, RefusesWhatIsNoRange) {
  for (const char* text : {"", "5", "a:b", "1:2:0", "1:2:-1", "-1:4", "1:2:3:4", "1 :2", "0x1:3",
                           "1.5:", "99999999999999999999:"})
    EXPECT_THROW(parse_frame_range(text), Error) << text;
}

TEST(FrameSourceConfig, ListsItsFields) {
  FrameSourceConfig config;
  ConfigFields fields;
  list_fields(config, fields);
  fields.set("max_depth_m", "4.5");
  EXPECT_FLOAT_EQ(config.max_depth_m, 4.5f);
  EXPECT_EQ(fields.fields().size(), 4u);
  EXPECT_THROW(fields.set("min_depth_m", "-1"), Error);
}

TEST(ChosenFrames, AreThoseOfTheRange) {
  fixture::TemporaryFolder folder;
  fixture::Sequence sequence;
  fixture::write_seven_scenes(folder.path(), sequence);
  const auto chosen = choose_frames(open_frame_source(folder.path()), parse_frame_range("1::3"));
  ASSERT_EQ(chosen->size(), (sequence.frames + 1) / 3);
  const FrameRead read = chosen->read(1);
  ASSERT_TRUE(read.frame);
  EXPECT_EQ(read.frame->index, 4) << "as the recording counts";
  EXPECT_THROW(choose_frames(open_frame_source(folder.path()), parse_frame_range("500:")), Error);
}

}  // namespace
}  // namespace ovimap
