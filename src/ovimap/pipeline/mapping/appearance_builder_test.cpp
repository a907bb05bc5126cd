// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/mapping/appearance_builder.h"

#include <algorithm>
#include <latch>
#include <numeric>

#include <gtest/gtest.h>

#include "ovimap/base/parallel.h"
#include "ovimap/frames/frame/registration.h"
#include "ovimap/pipeline/mapping/desk_fixture.h"
#include "ovimap/pipeline/mapping/mapper.h"
#include "ovimap/semantics/views/color_encoder_fixture.h"

namespace ovimap {
namespace {

MapperConfig small_views() {
  MapperConfig config;
  config.semantics.views.min_mask_px = 60;  // the desk's images are small
  config.semantics.views.min_first_depth_px = 40;
  config.semantics.crops.background_level = 0;
  return config;
}

/// What the desk's super-points look like to an encoder of colours.
SuperPointLooks look_at_desk(const MapperConfig& config,
                             std::shared_ptr<ImageTextEncoder> encoder) {
  Mapper mapper(config, std::make_shared<DeskMasks>(), std::move(encoder));
  const DeskScene scene;
  for (std::int64_t i = 0; i < scene.size(); ++i) mapper.process(*scene.read(i).frame);
  mapper.finish();
  return mapper.take_looks();
}

Eigen::VectorXf fused(const SuperPointLooks& looks, Label label) {
  return fuse_views(appearance_of(looks, std::vector<Label>{label}).views,
                    FeatureFusion::kPixelWeighted);
}

/// The super-point whose look is nearest to "red", "blue" among the fused embeddings.
Label most_like(const SuperPointLooks& looks, int channel) {
  Label best = kNoLabel;
  float most = -1;
  for (const auto& [label, look] : looks) {
    const Eigen::VectorXf embedding = fused(looks, label);
    if (embedding.size() > 0 && embedding[channel] > most) most = embedding[channel], best = label;
  }
  return best;
}

void expect_same(const SuperPointLooks& a, const SuperPointLooks& b) {
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
  const SuperPointLooks looks = look_at_desk(small_views(), std::make_shared<ColorEncoder>());
  EXPECT_GE(looks.size(), 3u);
  const Label red = most_like(looks, 0), blue = most_like(looks, 2);
  EXPECT_NE(red, blue);
  EXPECT_GT(fused(looks, red)[0], 0.85f);
  for (const auto& [label, look] : looks) {
    EXPECT_LE(look.views.size(), static_cast<std::size_t>(look.queries));
    if (look.views.empty()) continue;
    int crops = 0;
    for (const ObjectView& view : look.views) crops += !view.crop.empty();
    EXPECT_LE(crops, 4);
    EXPECT_GT(crops, 0);
  }
}

TEST(AppearanceBuilder, KeepsCropsWithoutAnEncoder) {
  MapperConfig config = small_views();
  config.view_interval = 1;
  const SuperPointLooks looks = look_at_desk(config, nullptr);
  EXPECT_GE(looks.size(), 3u);
  for (const auto& [label, look] : looks) {
    EXPECT_EQ(fused(looks, label).size(), 0);
    if (look.views.empty()) continue;
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

/// A wall, red on the left and blue on the right of column 40 of 120, two super-points that the
/// registry takes for one object or two.
class Wall {
 public:
  Wall() : depth_(120, 90, 2.f), labels_(120, 90, 2u), color_index_(120, 90) {
    frame_.color = RgbImage(120, 90, {0, 0, 250});
    frame_.color_camera = frame_.depth_camera = {120, 90, 100, 100, 59.5f, 44.5f};
    frame_.depth = depth_;
    for (int y = 0; y < 90; ++y)
      for (int x = 0; x < 120; ++x) {
        color_index_.at(x, y) = y * 120 + x;
        if (x >= 40) continue;
        labels_.at(x, y) = 1;
        frame_.color.at(x, y) = {250, 0, 0};
      }
    for (int i = 0; i < 2; ++i) forest.create();
    take_for(true);
  }

  void take_for(bool one_object) {
    InstanceRegistry::State state;
    for (const Label label : {1u, 2u})
      if (forest.root(label) == label)
        state.super_points[label] = {9, {{label, 9}}, FrameRuns({{0, 9}})};
    if (one_object) state.aliases = {{2, 1}};
    registry.restore(state);
  }

  int look(AppearanceBuilder& builder) {
    Image<InstanceId> ids(120, 90);
    Image<Label> roots(120, 90);
    for (std::size_t i = 0; i < ids.size(); ++i) {
      roots[i] = forest.root(labels_[i]);
      ids[i] = registry.instance_of(roots[i]);
    }
    ++frame_.index;
    const int chosen = builder.choose(frame_,
                                      {depth_, ids, roots, depth_, color_index_,
                                       frame_.depth_camera, Pose::Identity(), frame_.index},
                                      registry, forest);
    builder.submit();
    return chosen;
  }

  /// Smeared along rows over so many pixels.
  void smear(int px) {
    for (int y = 0; y < 90; ++y)
      for (int x = 0; x < 120; ++x) {
        const double blue = std::clamp((x - 40 + px / 2.0) / px, 0.0, 1.0);
        frame_.color.at(x, y) = {static_cast<std::uint8_t>(250 * (1 - blue)), 0,
                                 static_cast<std::uint8_t>(250 * blue)};
      }
  }
  void show_nothing() { color_index_.fill(Registration::kNoColor); }
  void show_all() { std::iota(color_index_.begin(), color_index_.end(), 0); }

  LabelForest forest;
  InstanceRegistry registry;

 private:
  Frame frame_;
  DepthImage depth_;
  Image<Label> labels_;
  Image<std::int32_t> color_index_;
};

/// Answers when it is told to.
class PatientEncoder : public ColorEncoder {
 public:
  Embeddings encode_images(std::span<const RgbImage> images) override {
    gate_.wait();
    return ColorEncoder::encode_images(images);
  }
  void open() { gate_.count_down(); }

 private:
  std::latch gate_{1};
};

TEST(AppearanceBuilder, ViewsGoWithTheirSuperPointWhenAnObjectFallsApart) {
  Wall wall;
  const auto encoder = std::make_shared<PatientEncoder>();
  AppearanceBuilder builder({}, encoder);
  EXPECT_EQ(wall.look(builder), 1);  // one object, mostly 2; the encoder has yet to answer
  wall.take_for(false);
  EXPECT_EQ(wall.look(builder), 1);  // 1 alone
  encoder->open();
  builder.finish(wall.forest);
  const SuperPointLooks& looks = builder.looks();
  const auto of = [&](InstanceId id) {
    return appearance_of(looks, wall.registry.super_points_of(id));
  };
  ASSERT_EQ(of(1).views.size(), 1u);
  ASSERT_EQ(of(2).views.size(), 1u);
  EXPECT_EQ(of(1).queries, 1);
  EXPECT_GT(of(1).views[0]->embedding[0], 0.9f) << "red";
  EXPECT_GT(of(2).views[0]->embedding[2], 0.7f) << "mostly blue";
  wall.take_for(true);
  EXPECT_EQ(of(1).views.size(), 2u);
}

TEST(AppearanceBuilder, LateAnswersFindViewsOfMergedSuperPoints) {
  Wall wall;
  wall.take_for(false);
  const auto encoder = std::make_shared<PatientEncoder>();
  AppearanceBuilder builder({}, encoder);
  EXPECT_EQ(wall.look(builder), 2);
  const auto stored = builder.remember(wall.forest);
  wall.forest.merge(1, 2);
  wall.take_for(true);
  wall.look(builder);
  EXPECT_FALSE(stored->complete());
  encoder->open();
  builder.finish(wall.forest);
  ASSERT_EQ(builder.looks().size(), 1u);
  EXPECT_GE(builder.looks().at(1).views.size(), 2u);
  for (const ObjectView& view : builder.looks().at(1).views) EXPECT_GT(view.embedding.size(), 0);
  ASSERT_TRUE(stored->complete());
  const SuperPointLooks then = stored->take();
  ASSERT_EQ(then.size(), 2u) << "as it was when it was remembered";
  for (const auto& [label, look] : then) EXPECT_GT(look.views.at(0).embedding.size(), 0);
}

TEST(AppearanceBuilder, WhatTheColourImageDoesNotShowStaysToBeLookedAt) {
  Wall wall;
  AppearanceBuilder builder({}, nullptr);
  wall.show_nothing();
  EXPECT_EQ(wall.look(builder), 0);
  for (const auto& [label, look] : builder.looks()) EXPECT_EQ(look.queries, 0);
  wall.show_all();
  EXPECT_EQ(wall.look(builder), 1);
}

TEST(AppearanceBuilder, ASmearedViewIsTakenOnlyUntilASharpOneComes) {
  Wall wall;
  AppearanceBuilder builder({}, nullptr);
  const auto views = [&] { return appearance_of(builder.looks(), std::vector<Label>{1, 2}).views; };
  wall.smear(20);
  EXPECT_EQ(wall.look(builder), 1) << "better than none";
  const int smeared_px = views()[0]->visible_px;
  EXPECT_LT(smeared_px, 120 * 90 / 5);
  EXPECT_EQ(wall.look(builder), 0);
  wall.smear(1);
  EXPECT_EQ(wall.look(builder), 1) << "what the smeared one showed is not covered";
  ASSERT_EQ(views().size(), 2u);
  EXPECT_EQ(views()[1]->visible_px, 120 * 90);
  wall.smear(20);
  EXPECT_EQ(wall.look(builder), 0);
  SemanticsConfig published;
  published.telling.sharp_edge_px = 0.f;
  AppearanceBuilder other(published, nullptr);
  EXPECT_EQ(wall.look(other), 1);
  EXPECT_EQ(appearance_of(other.looks(), std::vector<Label>{1, 2}).views[0]->visible_px, 120 * 90);
}

TEST(AppearanceBuilder, DoesNotDependOnThreadsOrTheEncodersPace) {
  const SuperPointLooks plain = look_at_desk(small_views(), std::make_shared<ColorEncoder>());
  expect_same(plain, look_at_desk(small_views(), std::make_shared<UnevenEncoder>()));
  MapperConfig narrow = small_views();
  narrow.semantics.queue.capacity = 1;
  narrow.semantics.queue.batch = 1;
  const ThreadLimit one(1);
  expect_same(plain, look_at_desk(narrow, std::make_shared<UnevenEncoder>()));
}

}  // namespace
}  // namespace ovimap
