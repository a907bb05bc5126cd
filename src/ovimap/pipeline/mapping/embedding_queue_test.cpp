// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/mapping/embedding_queue.h"

#include <thread>

#include <gtest/gtest.h>

#include "ovimap/semantics/views/color_encoder_fixture.h"

namespace ovimap {
namespace {

/// Answers only when told to, however long that takes.
class HeldEncoder : public ColorEncoder {
 public:
  Embeddings encode_images(std::span<const RgbImage> images) override {
    {
      std::unique_lock lock(gate_);
      opened_.wait(lock, [&] { return open_; });
    }
    if (fails) throw Error("the network is broken");
    return ColorEncoder::encode_images(images);
  }
  void open() {
    {
      const std::lock_guard lock(gate_);
      open_ = true;
    }
    opened_.notify_all();
  }
  std::atomic<bool> fails = false;

 private:
  std::mutex gate_;
  std::condition_variable opened_;
  bool open_ = false;
};

ObjectCrop crop_of(const RgbImage& image) {
  return {image,
          Image<std::uint8_t>(image.width(), image.height(), 1),
          {Eigen::Vector2i(0, 0), Eigen::Vector2i(image.width() - 1, image.height() - 1)}};
}

std::vector<EmbeddingRequest> one(std::int64_t frame, const RgbImage& image) {
  std::vector<EmbeddingRequest> requests;
  requests.push_back({{frame, 1}, crop_of(image)});
  return requests;
}

TEST(EmbeddingQueue, SlowEncodersSeeTheFrameTheyWereAskedAbout) {
  auto encoder = std::make_shared<HeldEncoder>();
  EmbeddingQueue queue({}, {}, encoder);
  RgbImage camera_buffer(8, 8, {250, 0, 0});  // a camera reuses its buffer for the next frame
  queue.submit(one(1, camera_buffer));
  camera_buffer.fill({0, 250, 0});
  queue.submit(one(2, camera_buffer));
  camera_buffer.fill({0, 0, 250});
  EXPECT_TRUE(queue.take().empty());
  encoder->open();
  const std::vector<EmbeddingAnswer> answers = queue.finish();
  ASSERT_EQ(answers.size(), 2u);
  EXPECT_EQ(answers[0].view, (ViewKey{1, 1}));
  EXPECT_TRUE(answers[0].embedding.isApprox(Eigen::Vector3f(1, 0, 0)));
  EXPECT_TRUE(answers[1].embedding.isApprox(Eigen::Vector3f(0, 1, 0)));
  EXPECT_GT(restore_crop(answers[0].crop).image.at(4, 4).r, 200);
}

/// Tells how red a picture is at its left, and where it was asked about.
class RedRecognizer : public ThingRecognizer {
 public:
  const RecognizerIdentity& identity() const override { return identity_; }
  std::unique_ptr<const ThingsInPicture> look(const RgbImage& picture) const override {
    if (fails) throw Error("the detector is broken");
    ++pictures_seen;
    struct Seen : ThingsInPicture {
      float red = 0;
      Eigen::VectorXf log_ratios(const Eigen::AlignedBox2f& box) const override {
        return Eigen::Vector2f(red, box.min().x());
      }
    };
    auto seen = std::make_unique<Seen>();
    seen->red = static_cast<float>(picture.at(0, 0).r);
    return seen;
  }
  mutable std::atomic<int> pictures_seen = 0;
  std::atomic<bool> fails = false;

 private:
  RecognizerIdentity identity_{"red", {"red thing", "place"}};
};

std::vector<EmbeddingRequest> two_of_one_picture(std::int64_t frame) {
  const auto picture = std::make_shared<const RgbImage>(8, 8, Rgb8{200, 0, 0});
  std::vector<EmbeddingRequest> requests;
  for (const float left : {0.25f, 0.5f}) {
    EmbeddingRequest request{
        {frame, requests.empty() ? 1u : 2u}, crop_of(RgbImage(4, 4, {200, 0, 0})), picture};
    request.crop.in_frame = {Eigen::Vector2f(left, 0), Eigen::Vector2f(left + 0.25f, 1)};
    requests.push_back(std::move(request));
  }
  return requests;
}

TEST(EmbeddingQueue, ViewsOfOneFrameShareOneLook) {
  const auto recognizer = std::make_shared<RedRecognizer>();
  EmbeddingQueue queue({.capacity = 8, .batch = 1}, {}, std::make_shared<ColorEncoder>());
  queue.recognize_with(recognizer);
  queue.submit(two_of_one_picture(1));
  queue.submit(one(2, RgbImage(4, 4)));
  const auto answers = queue.finish();
  ASSERT_EQ(answers.size(), 3u);
  EXPECT_EQ(answers[0].things, Eigen::Vector2f(200, 0.25f));
  EXPECT_EQ(answers[1].things, Eigen::Vector2f(200, 0.5f));
  EXPECT_EQ(answers[2].things.size(), 0) << "without a picture there is nothing to look at";
  EXPECT_EQ(recognizer->pictures_seen, 1);
}

TEST(EmbeddingQueue, ABrokenRecognizerCostsNoEmbedding) {
  const auto recognizer = std::make_shared<RedRecognizer>();
  recognizer->fails = true;
  EmbeddingQueue queue({}, {}, std::make_shared<ColorEncoder>());
  queue.recognize_with(recognizer);
  queue.submit(two_of_one_picture(1));
  EXPECT_THROW(queue.finish(), Error);
  const auto answers = queue.finish();
  ASSERT_EQ(answers.size(), 2u);
  EXPECT_EQ(answers[0].embedding.size(), 3);
  EXPECT_EQ(answers[0].things.size(), 0);
}

TEST(EmbeddingQueue, AFullQueueMakesTheMapperWait) {
  auto encoder = std::make_shared<HeldEncoder>();
  EmbeddingQueue queue({.capacity = 2, .batch = 1}, {}, encoder);
  std::atomic<int> submitted = 0;
  std::thread mapper([&] {
    for (std::uint64_t i = 0; i < 6; ++i) {
      queue.submit(one(i, RgbImage(4, 4, {9, 9, 9})));
      ++submitted;
    }
  });
  // One is being embedded, two wait, the fourth has no room: never more than three get in.
  while (submitted < 3) std::this_thread::yield();
  EXPECT_LE(submitted, 3);
  encoder->open();
  mapper.join();
  EXPECT_EQ(queue.finish().size(), 6u);
}

TEST(EmbeddingQueue, KeepsCropsWithoutAnEncoder) {
  EmbeddingQueue queue({}, {}, nullptr);
  queue.submit(one(1, RgbImage(4, 4, {9, 9, 9})));
  const auto answers = queue.finish();
  ASSERT_EQ(answers.size(), 1u);
  EXPECT_EQ(answers[0].embedding.size(), 0);
  EXPECT_FALSE(answers[0].crop.empty());
}

TEST(EmbeddingQueue, KeepsNoCropsWhenToldSo) {
  CropConfig crops;
  crops.kept_views = 0;
  EmbeddingQueue queue({}, crops, std::make_shared<ColorEncoder>());
  queue.submit(one(1, RgbImage(4, 4, {9, 9, 9})));
  const auto answers = queue.finish();
  EXPECT_TRUE(answers.front().crop.empty());
  EXPECT_EQ(answers.front().embedding.size(), 3);
}

TEST(EmbeddingQueue, PassesOnWhatTheEncoderThrows) {
  auto encoder = std::make_shared<HeldEncoder>();
  encoder->fails = true;
  encoder->open();
  EmbeddingQueue queue({}, {}, encoder);
  queue.submit(one(1, RgbImage(4, 4)));
  EXPECT_THROW(queue.finish(), Error);
  const auto broken = queue.finish();
  ASSERT_EQ(broken.size(), 1u);
  EXPECT_EQ(broken[0].embedding.size(), 0);
  EXPECT_FALSE(broken[0].crop.empty()) << "it can be embedded later";
}

TEST(EmbeddingQueue, GoesOnAfterAFailure) {
  auto encoder = std::make_shared<HeldEncoder>();
  encoder->fails = true;
  encoder->open();
  EmbeddingQueue queue({.capacity = 1, .batch = 1}, {}, encoder);
  for (std::uint64_t i = 0; i < 5; ++i) queue.submit(one(i, RgbImage(4, 4)));
  while (queue.waiting() > 0) std::this_thread::yield();
  EXPECT_TRUE(queue.take().empty()) << "not before it is reported";
  EXPECT_THROW(queue.finish(), Error);
  encoder->fails = false;
  queue.submit(one(5, RgbImage(4, 4, {250, 0, 0})));
  const auto answers = queue.finish();
  ASSERT_EQ(answers.size(), 6u);
  EXPECT_EQ(answers[4].embedding.size(), 0);
  EXPECT_EQ(answers[5].embedding.size(), 3);
  EXPECT_NO_THROW(queue.rethrow_failure());
}

TEST(EmbeddingQueue, CanBeLeftInTheMiddle) {
  auto encoder = std::make_shared<HeldEncoder>();
  {
    EmbeddingQueue queue({.capacity = 10, .batch = 1}, {}, encoder);
    for (std::uint64_t i = 0; i < 5; ++i) queue.submit(one(i, RgbImage(4, 4, {1, 1, 1})));
    encoder->open();
  }
  EXPECT_LE(encoder->images_seen, 30);
}

}  // namespace
}  // namespace ovimap
