// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/writing/writing_reader.h"

#include <gtest/gtest.h>

#include "ovimap/inference/models/test_support.h"

namespace ovimap {
namespace {

// The golden model's letters: red, green and blue read R, G, B, grey is a blank.
constexpr Rgb8 kWhite{255, 255, 255}, kGrey{89, 89, 89};
constexpr int kLetterPx = 8, kLinePx = 16;

Rgb8 ink_of(char letter) {
  constexpr std::uint8_t kBright = 204;
  return {letter == 'R' ? kBright : std::uint8_t{0}, letter == 'G' ? kBright : std::uint8_t{0},
          letter == 'B' ? kBright : std::uint8_t{0}};
}

void write(RgbImage& image, int left, int top, const std::string& text) {
  for (const char letter : text) {
    fill_box(image, left, top, left + kLetterPx, top + kLinePx,
             letter == ' ' ? kGrey : ink_of(letter));
    left += kLetterPx;
  }
}

WritingReader golden_reader() {
  return WritingReader(read_model_folder(inference_testdata() / "golden_writing"), {});
}

TEST(WritingReader, SpellsLinesFromTheTopDown) {
  RgbImage image(128, 96, kWhite);
  write(image, 32, 16, "RGB");
  write(image, 8, 56, "BG RB");
  const auto lines = golden_reader().read(image);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0].text, "RGB");
  EXPECT_EQ(lines[1].text, "BG RB");
  EXPECT_GT(lines[0].confidence, 0.95f);
  EXPECT_NEAR(lines[0].box_px.min().x(), 32, 1);
  EXPECT_NEAR(lines[0].box_px.max().y(), 31, 1);
}

TEST(WritingReader, OneLetterThatLastsIsOneAndBlanksAtTheEndsGo) {
  RgbImage image(128, 32, kWhite);
  write(image, 16, 8, " RRGG ");
  const auto lines = golden_reader().read(image);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0].text, "RG");
}

TEST(WritingReader, LargePicturesAreShrunkAndBoxesAreOfThePicture) {
  RgbImage image(512, 256, kWhite);  // four times the detector's longest side
  fill_box(image, 128, 96, 192, 160, ink_of('R'));
  fill_box(image, 192, 96, 256, 160, ink_of('B'));
  const auto lines = golden_reader().read(image);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0].text, "RB");
  EXPECT_NEAR(lines[0].box_px.min().x(), 128, 4);
  EXPECT_NEAR(lines[0].box_px.max().x(), 255, 4);
}

TEST(WritingReader, ReadsNothingWhereNothingIsWritten) {
  EXPECT_TRUE(golden_reader().read(RgbImage(64, 64, kWhite)).empty());
  EXPECT_TRUE(golden_reader().read({}).empty());
  EXPECT_TRUE(golden_reader().read(RgbImage(1, 1, kWhite)).empty());
}

TEST(WritingReader, SaysWhatIsWrongWithAModel) {
  const auto model = [](const std::string& name) {
    return read_model_folder(inference_testdata() / name);
  };
  EXPECT_TRUE(contains(error_of([&] { WritingReader(model("golden_clip"), {}); }), "kind writing"));
  ModelFolder without = model("golden_writing");
  without.extras.erase("growth");
  EXPECT_TRUE(contains(error_of([&] { WritingReader(without, {}); }), "'growth'"));
  // The detector's file tells no characters.
  ModelFolder swapped = model("golden_writing");
  swapped.networks["speller"] = swapped.networks["detector"];
  swapped.networks["speller"].inputs["line"] = "x";
  swapped.networks["speller"].outputs["characters"] = "ink";
  EXPECT_TRUE(contains(error_of([&] { WritingReader(swapped, {}); }), "characters"));
  EXPECT_TRUE(
      contains(error_of([] { make_writing_reader("no-such-model", {}); }), "no-such-model"));
}

}  // namespace
}  // namespace ovimap
