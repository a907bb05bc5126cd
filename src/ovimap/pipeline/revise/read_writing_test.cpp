// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/revise/read_writing.h"

#include <gtest/gtest.h>

#include "ovimap/base/error.h"
#include "ovimap/image/resize.h"
#include "ovimap/inference/models/test_support.h"
#include "ovimap/semantics/words/written_words.h"

namespace ovimap {
namespace {

constexpr Rgb8 kWhite{255, 255, 255}, kRed{204, 0, 0}, kBlue{0, 0, 204};

WritingReader golden_reader() {
  return WritingReader(read_model_folder(inference_testdata() / "golden_writing"), {});
}

/// A picture with "RB" in its left half and "BR" in its right; the object is the left half.
ObjectView view_of(std::int64_t frame, bool flat = false) {
  ObjectCrop crop{RgbImage(128, 64, kWhite),
                  Image<std::uint8_t>(128, 64),
                  {Eigen::Vector2i(0, 0), Eigen::Vector2i(63, 63)}};
  fill_box(crop.image, 16, 24, 24, 40, kRed);
  fill_box(crop.image, 24, 24, 32, 40, kBlue);
  fill_box(crop.image, 80, 24, 88, 40, kBlue);
  fill_box(crop.image, 88, 24, 96, 40, kRed);
  if (flat)  // the least sharp of all
    crop.image = RgbImage(128, 64, kWhite);
  fill_box(crop.mask, 0, 0, 64, 64, std::uint8_t{1});
  CropConfig config;
  ObjectView view;
  view.frame = frame;
  view.super_point = 1;
  view.crop = store_crop(crop, config);
  return view;
}

SemanticRecord record_of(std::vector<ObjectView> views) {
  SemanticRecord record;
  record.looks[1].views = std::move(views);
  return record;
}

TEST(ReadWriting, KeepsWhatIsOnTheObjectAndNotBesideIt) {
  SemanticRecord record = record_of({view_of(1)});
  const ReadWritingSummary summary = read_writing(record, golden_reader());
  EXPECT_EQ(summary.crops, 1u);
  EXPECT_EQ(summary.lines, 1u);
  const auto& lines = record.looks[1].views[0].writing;
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0].text, "RB");
  EXPECT_EQ(record.writing_reader, "golden writing");
}

TEST(ReadWriting, ReadsTheSharpestViewsAndForgetsEarlierReadings) {
  SemanticRecord record = record_of({view_of(1, true), view_of(2), view_of(3, true)});
  record.looks[1].views[0].writing = {{"old", 1.f, {}}};
  const ReadWritingSummary summary = read_writing(record, golden_reader(), {.sharpest_views = 1});
  EXPECT_EQ(summary.crops, 1u);
  EXPECT_TRUE(record.looks[1].views[0].writing.empty());
  EXPECT_EQ(record.looks[1].views[1].writing.size(), 1u);
  EXPECT_EQ(writing_of(Appearance{{}, {&record.looks[1].views[0], &record.looks[1].views[1]}, 0, 0})
                .size(),
            1u);
}

TEST(ReadWriting, SaysWhenThereIsNothingToReadAndKeepsWhatWasThere) {
  ObjectView bare = view_of(1);
  bare.crop = {};
  bare.writing = {{"old", 1.f, {}}};
  SemanticRecord record = record_of({bare});
  EXPECT_THROW(read_writing(record, golden_reader()), Error);
  EXPECT_EQ(record.looks[1].views[0].writing.size(), 1u);
}

TEST(ReadWriting, PrefersASharpCropToASmearedOne) {
  SemanticRecord record = record_of({view_of(1), view_of(2)});
  ObjectView& smeared = record.looks[1].views[0];
  ObjectCrop crop = restore_crop(smeared.crop);
  RgbImage small = resize_bilinear(crop.image, 32, 16);
  crop.image = resize_bilinear(small, 128, 64);
  smeared.crop = store_crop(crop, {});
  read_writing(record, golden_reader(), {.sharpest_views = 1});
  EXPECT_TRUE(record.looks[1].views[0].writing.empty());
  EXPECT_EQ(record.looks[1].views[1].writing.size(), 1u);
}

}  // namespace
}  // namespace ovimap
