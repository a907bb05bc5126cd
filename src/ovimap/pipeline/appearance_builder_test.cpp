// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/appearance_builder.h"

#include <gtest/gtest.h>

#include "ovimap/base/parallel.h"
#include "ovimap/pipeline/desk_fixture.h"
#include "ovimap/pipeline/mapper.h"
#include "ovimap/semantics/color_encoder_fixture.h"

namespace ovimap {
namespace {

MapperConfig small_views() {
  MapperConfig config;
  config.semantics.views.min_mask_px = 60;  // the desk's images are small
  config.semantics.views.min_first_depth_px = 40;
  config.semantics.crops.background_level = 0;
  return config;
}

/// What the desk's objects look like to an encoder of colours.
Appearances look_at_desk(const MapperConfig& config, std::shared_ptr<ImageTextEncoder> encoder) {
  Mapper mapper(config, std::make_shared<DeskMasks>(), std::move(encoder));
  const DeskScene scene;
  for (std::int64_t i = 0; i < scene.size(); ++i) mapper.process(*scene.read(i).frame);
  mapper.finish();
  return mapper.take_appearances();
}

/// Instances whose look is nearest to each of "red", "blue" among the fused embeddings.
InstanceId most_like(const Appearances& looks, int channel) {
  InstanceId best = 0;
  float most = -1;
  for (const auto& [id, look] : looks) {
    const Eigen::VectorXf fused = fuse_views(look.views, FeatureFusion::kPixelWeighted);
    if (fused.size() > 0 && fused[channel] > most) most = fused[channel], best = id;
  }
  return best;
}

void expect_same(const Appearances& a, const Appearances& b) {
  ASSERT_EQ(a.size(), b.size());
  for (auto x = a.begin(), y = b.begin(); x != a.end(); ++x, ++y) {
    EXPECT_EQ(x->first, y->first);
    ASSERT_EQ(x->second.views.size(), y->second.views.size());
    for (std::size_t i = 0; i < x->second.views.size(); ++i) {
      EXPECT_EQ(x->second.views[i].frame, y->second.views[i].frame);
      EXPECT_EQ(x->second.views[i].embedding, y->second.views[i].embedding);
      EXPECT_EQ(x->second.views[i].crop.image_jpeg, y->second.views[i].crop.image_jpeg);
    }
  }
}

TEST(AppearanceBuilder, TellsTheBallsApart) {
  const Appearances looks = look_at_desk(small_views(), std::make_shared<ColorEncoder>());
  EXPECT_GE(looks.size(), 3u);
  const InstanceId red = most_like(looks, 0), blue = most_like(looks, 2);
  EXPECT_NE(red, blue);
  const Eigen::VectorXf fused = fuse_views(looks.at(red).views, FeatureFusion::kPixelWeighted);
  EXPECT_GT(fused[0], 0.85f);
  for (const auto& [id, look] : looks) {
    EXPECT_LE(look.views.size(), static_cast<std::size_t>(look.queries));
    int crops = 0;
    for (const ObjectView& view : look.views) crops += !view.crop.empty();
    EXPECT_LE(crops, 4);
    EXPECT_GT(crops, 0);
  }
}

TEST(AppearanceBuilder, KeepsCropsWithoutAnEncoder) {
  MapperConfig config = small_views();
  config.view_interval = 1;
  const Appearances looks = look_at_desk(config, nullptr);
  EXPECT_GE(looks.size(), 3u);
  for (const auto& [id, look] : looks) {
    EXPECT_EQ(fuse_views(look.views, FeatureFusion::kPixelWeighted).size(), 0);
    EXPECT_FALSE(look.views.front().crop.empty() && look.views.back().crop.empty());
  }
}

/// As quick as ColorEncoder on some calls and far behind on others.
class UnevenEncoder : public ColorEncoder {
 public:
  Embeddings encode_images(std::span<const RgbImage> images) override {
    for (int i = 0; i < (++calls_ % 3) * 200000; ++i) wasted_ = wasted_ + 1;
    return ColorEncoder::encode_images(images);
  }

 private:
  int calls_ = 0;
  volatile int wasted_ = 0;
};

TEST(AppearanceBuilder, DoesNotDependOnThreadsOrTheEncodersPace) {
  const Appearances plain = look_at_desk(small_views(), std::make_shared<ColorEncoder>());
  expect_same(plain, look_at_desk(small_views(), std::make_shared<UnevenEncoder>()));
  MapperConfig narrow = small_views();
  narrow.semantics.queue.capacity = 1;
  narrow.semantics.queue.batch = 1;
  const ThreadLimit one(1);
  expect_same(plain, look_at_desk(narrow, std::make_shared<UnevenEncoder>()));
}

}  // namespace
}  // namespace ovimap
