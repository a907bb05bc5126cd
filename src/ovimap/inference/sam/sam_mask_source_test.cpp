// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/sam/sam_mask_source.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>

#include "ovimap/image/codec.h"
#include "ovimap/inference/mask_source_factory.h"
#include "ovimap/inference/masks/logit_grid.h"
#include "ovimap/inference/models/test_support.h"

namespace ovimap {
namespace {

namespace fs = std::filesystem;

constexpr Rgb8 kFloor{40, 40, 40}, kTable{200, 140, 60}, kMug{60, 90, 220};

/// Plain patches whose edges lie on the golden networks' cells: 4 x 4 pixels where the aspect is
/// kept, 4 x 2 where the height is stretched to twice its size.
Frame patches() {
  Frame frame;
  frame.color = RgbImage(64, 32, kFloor);
  fill_box(frame.color, 8, 4, 40, 28, kTable);
  fill_box(frame.color, 16, 8, 28, 20, kMug);
  return frame;
}

SamConfig small_image_config() {
  SamConfig config;
  config.min_mask_px = 8;
  config.min_region_px = 32;
  config.min_hole_radius_px = 4;
  return config;
}

ModelFolder golden(const std::string& signature) {
  return read_model_folder(inference_testdata() / "golden_sam" / signature);
}

class SamSignature : public testing::TestWithParam<const char*> {};

TEST_P(SamSignature, DecodesBatchesInOrder) {
  const SamNetwork network(golden(GetParam()), {});
  const Frame frame = patches();
  const ImageFeatures features = network.encode(frame.color);
  std::vector<PromptPoints> prompts;
  for (const Eigen::Vector2f& at : {Eigen::Vector2f(21, 13), Eigen::Vector2f(50, 20)})
    prompts.push_back({{at, PointLabel::kForeground}, {{0, 0}, PointLabel::kPadding}});
  const auto answers = network.decode(features, prompts);
  ASSERT_EQ(answers.size(), 2u);
  const LogitGrid grid =
      logit_grid(features.frame, network.input_size_px(), network.grid_size(), 64, 32);
  for (std::size_t i = 0; i < answers.size(); ++i) {
    ASSERT_EQ(answers[i].tokens, 3);
    ASSERT_EQ(answers[i].grid_size, 16);
    EXPECT_FLOAT_EQ(answers[i].predicted_iou[1], 0.97f);
    // The first answer is the mug, the second the floor: look at both places in both.
    const LogitRow mug(std::span(answers[i].logits).first(256), grid, 13);
    const LogitRow floor(std::span(answers[i].logits).first(256), grid, 20);
    EXPECT_EQ(mug.at(21) > 0, i == 0);
    EXPECT_EQ(floor.at(50) > 0, i == 1);
  }
}

TEST_P(SamSignature, FindsThePatches) {
  SamMaskSource source(golden(GetParam()), small_image_config(), {});
  EXPECT_EQ(source.kind(), "sam");
  const Entities entities = *source.entities(patches(), {});
  ASSERT_EQ(entities.scores.size(), 3u);
  ASSERT_TRUE(entities.ids.same_size(patches().color));
  const std::uint16_t floor = entities.ids.at(50, 20), table = entities.ids.at(34, 24),
                      mug = entities.ids.at(21, 13);
  EXPECT_EQ((std::set<std::uint16_t>{floor, table, mug}), (std::set<std::uint16_t>{1, 2, 3}));
  // Away from the patches' edges every pixel has its patch's id.
  for (const auto& [x, y] : {std::pair{2, 2}, {61, 29}, {3, 16}})
    EXPECT_EQ(entities.ids.at(x, y), floor);
  for (const auto& [x, y] : {std::pair{11, 6}, {37, 25}, {11, 25}})
    EXPECT_EQ(entities.ids.at(x, y), table);
}

TEST_P(SamSignature, FindsThePatchesOnAGrid) {
  SamConfig config = small_image_config();
  config.prompting = Prompting::kGrid;
  config.grid_side = 8;
  SamMaskSource source(golden(GetParam()), config, {});
  const Entities entities = *source.entities(patches(), {});
  ASSERT_EQ(entities.scores.size(), 3u);
  EXPECT_EQ((std::set<std::uint16_t>{entities.ids.at(50, 20), entities.ids.at(34, 24),
                                     entities.ids.at(21, 13)}),
            (std::set<std::uint16_t>{1, 2, 3}));
}

INSTANTIATE_TEST_SUITE_P(Signatures, SamSignature,
                         testing::Values("batched", "sam", "sam2", "efficient"),
                         [](const auto& signature) { return std::string(signature.param); });

std::vector<float> numbers_of(const fs::path& file) {
  std::ifstream stream(file);
  return {std::istream_iterator<float>(stream), {}};
}

/// Logits and scores must be near, and no logit may change its side.
void expect_near(const MaskProposals& proposals, const std::string& prompt) {
  const fs::path folder = inference_testdata() / "golden_sam_hf";
  const std::vector<float> masks = numbers_of(folder / (prompt + "_masks.txt"));
  const std::vector<float> scores = numbers_of(folder / (prompt + "_scores.txt"));
  ASSERT_EQ(proposals.logits.size(), masks.size());
  ASSERT_EQ(proposals.predicted_iou.size(), scores.size());
  for (std::size_t i = 0; i < masks.size(); ++i) {
    EXPECT_NEAR(proposals.logits[i], masks[i], 1e-3) << i;
    EXPECT_EQ(proposals.logits[i] > 0, masks[i] > 0) << i;
  }
  for (std::size_t i = 0; i < scores.size(); ++i)
    EXPECT_NEAR(proposals.predicted_iou[i], scores[i], 1e-4) << i;
}

// A tiny SAM written by tools/models/export_model.py; the answers come from Hugging Face's image
// processor and network in torch. The image is resized on the way in.
TEST(SamNetwork, AgreesWithHuggingFace) {
  const SamNetwork network(read_model_folder(inference_testdata() / "golden_sam_hf"), {});
  const RgbImage image = read_rgb(inference_testdata() / "golden_sam_hf/image.png");
  const ImageFeatures features = network.encode(image);
  // The prompts of tools/models/make_golden_masks.py.
  const PromptPoint point{{41, 30}, PointLabel::kForeground}, padding{{0, 0}, PointLabel::kPadding},
      box_min{{20, 12}, PointLabel::kBoxMin}, box_max{{70, 52}, PointLabel::kBoxMax};
  const std::vector<PromptPoints> by_point(2, {point, padding});
  for (const MaskProposals& proposals : network.decode(features, by_point))
    expect_near(proposals, "point");
  const std::vector<PromptPoints> by_box = {{point, box_min, box_max}};
  expect_near(network.decode(features, by_box).front(), "point_and_box");
}

TEST(SamMaskSource, AsksNoMoreThanItsBudget) {
  SamConfig config = small_image_config();
  config.max_decoder_prompts = 1;
  SamMaskSource source(golden("batched"), config, {});
  EXPECT_EQ(source.entities(patches(), {})->scores.size(), 1u);
}

TEST(SamMaskSource, RegionsArePromptedFirst) {
  SamConfig config = small_image_config();
  config.max_decoder_prompts = 1;
  config.hole_weight = 0;
  SamMaskSource source(golden("batched"), config, {});
  const std::vector<MaskPrompt> prompts = {
      {{21, 13}, Eigen::AlignedBox2f(Eigen::Vector2f(16, 8), Eigen::Vector2f(27, 19)), 144}};
  const Entities entities = *source.entities(patches(), prompts);
  ASSERT_EQ(entities.scores.size(), 1u);
  EXPECT_EQ(entities.ids.at(21, 13), 1);
  EXPECT_EQ(entities.ids.at(50, 20), 0);
}

TEST(SamMaskSource, SameAnswerForAnyNumberOfThreads) {
  RuntimeConfig one, two;
  one.threads = 1;
  two.threads = 2;
  SamMaskSource a(golden("batched"), small_image_config(), one);
  SamMaskSource b(golden("batched"), small_image_config(), two);
  EXPECT_EQ(a.entities(patches(), {})->ids, b.entities(patches(), {})->ids);
}

TEST(SamNetwork, SaysWhichTensorIsWrong) {
  const fixture::TemporaryFolder scratch;
  fs::copy(inference_testdata() / "golden_sam/batched", scratch.path(),
           fs::copy_options::recursive);
  const Bytes bytes = read_file(scratch.path() / "model.yaml");
  const std::string yaml(bytes.begin(), bytes.end());
  const auto message = [&](const std::string& from, const std::string& to) {
    std::string text = yaml;
    scratch.write("model.yaml", text.replace(text.find(from), from.size(), to));
    return error_of([&] { SamNetwork(read_model_folder(scratch.path()), {}); });
  };
  EXPECT_TRUE(
      contains(message("masks: masks", "masks: mask"), "no output named 'mask'; it has masks"));
  EXPECT_TRUE(contains(message("points: points", "points: coords"), "no input named 'coords'"));
  EXPECT_TRUE(contains(message("kind: sam", "kind: entity"), "of kind 'entity'"));
  EXPECT_TRUE(contains(message("size: 64", "size: 32"), "expected [any,3,32,32]"));
  EXPECT_TRUE(contains(message("decoder.onnx: ", "decoder.onnx: 0"), "has SHA-256"));
}

// The real model, when tools/setup.sh has fetched it: plain objects on a plain ground must come
// out.
TEST(SamMaskSource, AsksForWhatItsFinderSees) {
  SamConfig config = small_image_config();
  config.min_hole_radius_px = 1000;  // nothing else is asked for
  SamMaskSource source(golden("finder"), config, {});
  const Entities entities = *source.entities(patches(), {});
  ASSERT_EQ(entities.scores.size(), 1u);
  EXPECT_EQ(entities.ids.at(21, 13), 1);
  EXPECT_EQ(entities.ids.at(34, 24), 0);

  config.finder.max_prompts = 0;
  EXPECT_TRUE(SamMaskSource(golden("finder"), config, {}).entities(patches(), {})->scores.empty());
}

class DefaultModel : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(SamMaskSource, DefaultModel, testing::Bool(), [](const auto& of) {
  return of.param ? "InBytesWhereItCan" : "InFullPrecision";
});

TEST_P(DefaultModel, SeparatesPlainObjects) {
  const auto models = list_models(model_search_path({fs::path(OVIMAP_SOURCE_DIR) / ".models"}));
  if (std::none_of(models.begin(), models.end(),
                   [](const auto& m) { return m.name == kDefaultSamModel; }))
    GTEST_SKIP() << "the default model is not there; run tools/setup.sh";
  MaskSourceContext context;
  context.model_dirs = {fs::path(OVIMAP_SOURCE_DIR) / ".models"};
  MaskSourceConfig config;
  config.runtime.int8 = GetParam();
  const auto source = make_mask_source("sam", config, context);
  Frame frame;
  frame.color = RgbImage(320, 240, Rgb8{90, 90, 95});
  fill_box(frame.color, 40, 60, 120, 180, Rgb8{210, 60, 50});
  fill_box(frame.color, 190, 80, 270, 150, Rgb8{40, 120, 220});
  const Entities entities = *source->entities(frame, {});
  const std::uint16_t red = entities.ids.at(80, 120), blue = entities.ids.at(230, 115);
  EXPECT_NE(red, 0);
  EXPECT_NE(blue, 0);
  EXPECT_NE(red, blue);
  const auto area = [&](std::uint16_t id) {
    return std::count(entities.ids.begin(), entities.ids.end(), id);
  };
  EXPECT_NEAR(static_cast<double>(area(red)), 80 * 120, 0.05 * 80 * 120);
  EXPECT_NEAR(static_cast<double>(area(blue)), 80 * 70, 0.05 * 80 * 70);
}

}  // namespace
}  // namespace ovimap
