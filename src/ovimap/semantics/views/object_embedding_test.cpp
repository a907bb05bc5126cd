// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/views/object_embedding.h"

#include <gtest/gtest.h>

#include "ovimap/semantics/views/color_encoder_fixture.h"

namespace ovimap {
namespace {

ObjectCrop crop_of(Rgb8 color) {
  return {RgbImage(20, 10, color),
          Image<std::uint8_t>(20, 10, 1),
          {Eigen::Vector2i(2, 2), Eigen::Vector2i(17, 7)}};
}

TEST(EmbedObjects, AveragesTheCropsOfEachObjectInOneBatch) {
  ColorEncoder encoder;
  const ObjectCrop red = crop_of({200, 0, 0}), blue = crop_of({0, 0, 90});
  const std::vector<const ObjectCrop*> objects = {&red, &blue};
  CropConfig config;
  config.background_level = 0;
  const auto embeddings = embed_objects(encoder, objects, config);
  ASSERT_EQ(embeddings.size(), 2u);
  EXPECT_TRUE(embeddings[0].isApprox(Eigen::Vector3f(1, 0, 0)));
  EXPECT_TRUE(embeddings[1].isApprox(Eigen::Vector3f(0, 0, 1)));
  EXPECT_EQ(encoder.images_seen, 12);  // three scales, with and without background
}

TEST(EmbedObjects, HasNothingToSayOfFailedCrops) {
  ColorEncoder encoder;  // gives zeros for black images, as an encoder does for what is not finite
  const ObjectCrop black = crop_of({0, 0, 0}), red = crop_of({200, 0, 0});
  const std::vector<const ObjectCrop*> objects = {&black, &red};
  const auto embeddings = embed_objects(encoder, objects, {});
  EXPECT_EQ(embeddings[0].size(), 0);
  EXPECT_EQ(embeddings[1].size(), 3);
  EXPECT_TRUE(embed_objects(encoder, {}, {}).empty());
}

}  // namespace
}  // namespace ovimap
