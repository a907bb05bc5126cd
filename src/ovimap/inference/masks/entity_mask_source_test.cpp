// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/masks/entity_mask_source.h"

#include <gtest/gtest.h>

#include <fstream>

#include "ovimap/image/codec.h"
#include "ovimap/inference/masks/entity_ids.h"
#include "ovimap/inference/models/test_support.h"

namespace ovimap {
namespace {

std::filesystem::path golden_folder() {
  return inference_testdata() / "golden_entity";
}

EntityConfig golden_config() {
  EntityConfig config;
  config.min_mask_px = 40;  // as in tools/models/make_golden_{entity,masks}.py
  return config;
}

/// `folder`'s network must make of image.png the ids and scores that lie beside it.
void expect_golden(const std::filesystem::path& folder) {
  EntityMaskSource source(read_model_folder(folder), golden_config(), {});
  EXPECT_EQ(source.kind(), "entity");
  Frame frame;
  frame.color = read_rgb(folder / "image.png");
  const Entities entities = *source.entities(frame, {});
  EXPECT_EQ(entities.ids, read_gray(folder / "ids.png").values);
  std::ifstream expected(folder / "scores.txt");
  for (const float score : entities.scores) {
    float wanted = -1;
    expected >> wanted;
    EXPECT_NEAR(score, wanted, 1e-5);
  }
  float more = 0;
  EXPECT_FALSE(expected >> more);
}

// NumPy's answer, computed by tools/models/make_golden_entity.py without this code or the runtime.
TEST(EntityMaskSource, AgreesWithNumPy) {
  expect_golden(golden_folder());
}

// A tiny Mask2Former written by tools/models/export_model.py; the answer comes from Hugging Face's
// image processor and network in torch. The image is resized on the way in.
TEST(EntityMaskSource, AgreesWithHuggingFace) {
  expect_golden(inference_testdata() / "golden_mask2former");
}

/// A 4 x 4 grid over an image of 4 x 4 pixels.
LogitGrid tiny_grid() {
  ImageInputSpec spec;
  spec.size_px = 4;
  return logit_grid(input_frame(4, 4, spec), 4, 4, 4, 4);
}

/// Two queries: one is inside in the left three columns, the other in the right two.
FloatTensor two_masks(float left_logit, float right_logit) {
  FloatTensor masks{{1, 2, 4, 4}, {}};
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x) masks.values.push_back(x < 3 ? left_logit : -9.f);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x) masks.values.push_back(x >= 2 ? right_logit : -9.f);
  return masks;
}

TEST(EntitiesOfQueries, HigherScoreWinsTheOverlap) {
  EntityConfig config;
  config.min_mask_px = 1;
  // Class probabilities sigmoid(3) and sigmoid(1); mask probabilities sigmoid(2) and sigmoid(6).
  const FloatTensor classes{{1, 2, 2}, {3, 0, 1, 0}};
  const Entities entities = entities_of_queries(classes, two_masks(2, 6), tiny_grid(), config);
  ASSERT_EQ(entities.scores.size(), 2u);
  EXPECT_NEAR(entities.scores[0], 0.7310586 * 0.9975274, 1e-5);  // ascending
  EXPECT_NEAR(entities.scores[1], 0.9525741 * 0.8807971, 1e-5);
  for (int y = 0; y < 4; ++y) {
    EXPECT_EQ(entities.ids.at(2, y), 2);
    EXPECT_EQ(entities.ids.at(3, y), 1);
  }
}

TEST(EntitiesOfQueries, NoObjectAndWeakMasksAreDropped) {
  EntityConfig config;
  config.min_mask_px = 1;
  const FloatTensor no_object{{1, 2, 2}, {0, 5, 3, 0}};
  EXPECT_EQ(entities_of_queries(no_object, two_masks(6, 6), tiny_grid(), config).scores.size(), 1u);
  const FloatTensor sure{{1, 2, 2}, {3, 0, 3, 0}};  // 0.95 * sigmoid(0.05) is under a half
  EXPECT_TRUE(entities_of_queries(sure, two_masks(0.05f, -9), tiny_grid(), config).scores.empty());
}

TEST(EntitiesOfQueries, TooSmallEntitiesDisappear) {
  EntityConfig config;
  config.min_mask_px = 5;
  // The right query keeps four visible pixels under the better left one.
  const FloatTensor classes{{1, 2, 2}, {6, 0, 2, 0}};
  const Entities entities = entities_of_queries(classes, two_masks(6, 6), tiny_grid(), config);
  ASSERT_EQ(entities.scores.size(), 1u);
  EXPECT_EQ(entities.ids.at(0, 0), 1);
  EXPECT_EQ(entities.ids.at(3, 0), 0);
}

TEST(EntityMaskSource, RefusesAnotherKind) {
  const ModelFolder sam = read_model_folder(inference_testdata() / "golden_sam/batched");
  EXPECT_TRUE(contains(error_of([&] { EntityMaskSource(sam, {}, {}); }), "of kind 'sam'"));
}

TEST(EntityIds, RenumbersInAscendingOrder) {
  IdImage ids(3, 1);
  ids.at(0, 0) = 65535;
  ids.at(2, 0) = 300;
  const Entities entities = entities_of_ids(ids);
  EXPECT_EQ(entities.scores, (std::vector<float>{1, 1}));
  EXPECT_EQ(entities.ids.at(0, 0), 2);
  EXPECT_EQ(entities.ids.at(1, 0), 0);
  EXPECT_EQ(entities.ids.at(2, 0), 1);
}

TEST(EntityIds, KeepsTheVisible) {
  Entities entities{IdImage(4, 1), {0.1f, 0.2f, 0.3f}};
  entities.ids.at(0, 0) = 1;
  entities.ids.at(1, 0) = entities.ids.at(2, 0) = 3;
  const Entities all = keep_visible(entities, 0);
  EXPECT_EQ(all.scores, (std::vector<float>{0.1f, 0.3f}));
  EXPECT_EQ(all.ids.at(1, 0), 2);
  const Entities large = keep_visible(entities, 2);
  EXPECT_EQ(large.scores, (std::vector<float>{0.3f}));
  EXPECT_EQ(large.ids.at(0, 0), 0);
  EXPECT_EQ(large.ids.at(2, 0), 1);
}

}  // namespace
}  // namespace ovimap
