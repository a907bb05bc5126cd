// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/mapping/embedding_queue.h"

#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "ovimap/semantics/views/color_encoder_fixture.h"

namespace ovimap {
namespace {

/// Answers only when told to, however long that takes.
class PatientEncoder : public ColorEncoder {
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
  auto encoder = std::make_shared<PatientEncoder>();
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

TEST(EmbeddingQueue, AFullQueueMakesTheMapperWait) {
  auto encoder = std::make_shared<PatientEncoder>();
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
  auto encoder = std::make_shared<PatientEncoder>();
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
  auto encoder = std::make_shared<PatientEncoder>();
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
  auto encoder = std::make_shared<PatientEncoder>();
  {
    EmbeddingQueue queue({.capacity = 10, .batch = 1}, {}, encoder);
    for (std::uint64_t i = 0; i < 5; ++i) queue.submit(one(i, RgbImage(4, 4, {1, 1, 1})));
    encoder->open();
  }
  EXPECT_LE(encoder->images_seen, 30);
}

}  // namespace
}  // namespace ovimap
