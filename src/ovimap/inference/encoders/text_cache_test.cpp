// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/encoders/text_cache.h"

#include <gtest/gtest.h>

#include <fstream>

#include "ovimap/base/temporary_folder_fixture.h"

namespace ovimap {
namespace {

/// Gives each text a direction, and counts how many it was asked for.
class CountingEncoder : public ImageTextEncoder {
 public:
  explicit CountingEncoder(int& asked, std::string digest = "a") : asked_(asked) {
    identity_ = {"counting", 3, std::move(digest)};
  }
  const EncoderIdentity& identity() const override { return identity_; }
  std::optional<MatchCalibration> calibration() const override { return std::nullopt; }
  Embeddings encode_images(std::span<const RgbImage>) override { return {}; }
  Embeddings encode_texts(std::span<const std::string> texts) override {
    asked_ += static_cast<int>(texts.size());
    Embeddings rows(static_cast<Eigen::Index>(texts.size()), 3);
    for (Eigen::Index i = 0; i < rows.rows(); ++i)
      rows.row(i) << static_cast<float>(i + 1), static_cast<float>(texts[0].size()), 1.f;
    return rows;
  }

 private:
  int& asked_;
  EncoderIdentity identity_;
};

class TextCacheTest : public ::testing::Test {
 protected:
  std::unique_ptr<ImageTextEncoder> encoder(const std::string& digest = "a") {
    return remember_text_lists(std::make_unique<CountingEncoder>(asked_, digest), folder_);
  }
  static std::vector<std::string> list(std::size_t count, const std::string& first = "word") {
    std::vector<std::string> texts(count, "word");
    texts[0] = first;
    return texts;
  }
  std::vector<std::filesystem::path> files() const {
    std::vector<std::filesystem::path> found;
    if (!std::filesystem::exists(folder_)) return found;
    for (const auto& entry : std::filesystem::directory_iterator(folder_))
      found.push_back(entry.path());
    return found;
  }

  const fixture::TemporaryFolder scratch_;
  const std::filesystem::path folder_ = scratch_.path() / "cache";
  int asked_ = 0;
};

TEST_F(TextCacheTest, EncodesAListOnceForAllProcesses) {
  const auto first = encoder();
  const Embeddings rows = first->encode_vocabulary(list(100));
  EXPECT_EQ(first->encode_vocabulary(list(100)), rows);
  EXPECT_EQ(asked_, 100);
  EXPECT_EQ(encoder()->encode_vocabulary(list(100)), rows);  // as another process would
  EXPECT_EQ(asked_, 100);
  EXPECT_EQ(files().size(), 1u);
}

TEST_F(TextCacheTest, TellsListsAndModelsApart) {
  encoder()->encode_vocabulary(list(100));
  encoder()->encode_vocabulary(list(100, "other"));
  encoder()->encode_vocabulary(list(99));
  encoder("b")->encode_vocabulary(list(100));
  EXPECT_EQ(asked_, 399);
}

TEST_F(TextCacheTest, RemembersQueriesButNeverStoresThem) {
  const auto one = encoder();
  const Embeddings rows = one->encode_texts(list(3));
  EXPECT_EQ(one->encode_texts(list(3)), rows);
  EXPECT_EQ(asked_, 3);
  EXPECT_NE(one->encode_texts(list(3, "other")), rows);
  EXPECT_NE(one->encode_texts(list(2)).rows(), rows.rows());
  EXPECT_EQ(asked_, 8);
  EXPECT_TRUE(files().empty());
}

TEST_F(TextCacheTest, ALongQuestionIsNoVocabulary) {
  const auto one = encoder();
  for (int i = 0; i < 200; ++i) one->encode_texts(list(10000, "question " + std::to_string(i)));
  EXPECT_TRUE(files().empty());
  const int asked = asked_;
  one->encode_texts(list(10000, "question 0"));  // memory has a bound as well
  EXPECT_EQ(asked_, asked + 10000);
}

TEST_F(TextCacheTest, ForgetsTheQueriesThatWereNotAskedForTheLongest) {
  const auto one = encoder();
  constexpr int kFit = 4;  // of texts so long that a fifth does not
  const auto ask = [&](int number) {
    const auto letter = static_cast<char>('a' + number);
    one->encode_texts(list(1, std::string(kRecentTextBytes / (kFit + 1) + 1000, letter)));
  };
  for (int i = 0; i < kFit; ++i) ask(i);
  ask(0);
  EXPECT_EQ(asked_, kFit);
  ask(kFit);  // the second goes
  ask(0);
  EXPECT_EQ(asked_, kFit + 1);
  ask(1);
  EXPECT_EQ(asked_, kFit + 2);
}

TEST_F(TextCacheTest, DoesWithoutDamagedFiles) {
  const Embeddings rows = encoder()->encode_vocabulary(list(100));
  {
    std::fstream file(files().at(0), std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(200);
    file.put('\x7f');
  }
  EXPECT_EQ(encoder()->encode_vocabulary(list(100)), rows);
  EXPECT_EQ(asked_, 200);
  std::filesystem::resize_file(files().at(0), 10);
  EXPECT_EQ(encoder()->encode_vocabulary(list(100)), rows);
  EXPECT_EQ(encoder()->encode_vocabulary(list(100)), rows);  // it was written anew
  EXPECT_EQ(asked_, 300);
}

TEST_F(TextCacheTest, DoesWithoutAFolder) {
  std::ofstream(folder_.string()) << "a file where the folder should be";
  EXPECT_EQ(encoder()->encode_vocabulary(list(100)).rows(), 100);
  EXPECT_EQ(encoder()->encode_vocabulary(list(100)).rows(), 100);
  EXPECT_EQ(asked_, 200);
}

}  // namespace
}  // namespace ovimap
