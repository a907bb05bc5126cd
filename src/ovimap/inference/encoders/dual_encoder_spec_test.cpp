// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/encoders/dual_encoder_spec.h"

#include <gtest/gtest.h>

#include "ovimap/inference/models/test_support.h"

namespace ovimap {
namespace {

ModelFolder small_model() {
  ModelFolder model;
  model.folder = "/models/small";
  model.kind = "dual_encoder";
  model.input.size_px = 32;
  model.extras = {{"embedding_dim", "16"},
                  {"tokenizer", "clip_bpe"},
                  {"tokenizer_vocab", "vocab.json"},
                  {"context_length", "77"}};
  return model;
}

std::string error_with(const std::string& key, const std::string& value) {
  ModelFolder model = small_model();
  model.extras[key] = value;
  return error_of([&] { read_dual_encoder_spec(model); });
}

TEST(DualEncoderSpec, ReadsEveryKey) {
  ModelFolder model = small_model();
  for (const auto& [key, value] : std::map<std::string, std::string>{{"text_rule", "clip"},
                                                                     {"pad_to_context", "true"},
                                                                     {"pad_side", "left"},
                                                                     {"pad_id", "9"},
                                                                     {"bos_id", "7"},
                                                                     {"eos_id", "8"},
                                                                     {"logit_scale", "100.5"},
                                                                     {"logit_bias", "-1e1"},
                                                                     {"prompt_template", "a {}"}})
    model.extras[key] = value;
  const DualEncoderSpec spec = read_dual_encoder_spec(model);
  EXPECT_EQ(spec.dimension, 16);
  EXPECT_EQ(spec.text.tokenizer, "clip_bpe");
  EXPECT_EQ(spec.text.rule, TextRule::kClip);
  EXPECT_EQ(spec.text.context_length, 77);
  EXPECT_TRUE(spec.text.pad_to_context);
  EXPECT_TRUE(spec.text.pad_left);
  EXPECT_EQ(spec.text.pad_id, 9);
  EXPECT_EQ(spec.text.begin_id, 7);
  EXPECT_EQ(spec.text.end_id, 8);
  ASSERT_TRUE(spec.calibration);
  EXPECT_EQ(spec.calibration->scale, 100.5f);
  EXPECT_EQ(spec.calibration->bias, -10.f);
  EXPECT_EQ(spec.prompt_template, "a {}");
}

TEST(DualEncoderSpec, AbsentKeysHaveDefaults) {
  const DualEncoderSpec spec = read_dual_encoder_spec(small_model());
  EXPECT_EQ(spec.text.rule, TextRule::kNone);
  EXPECT_FALSE(spec.text.pad_to_context);
  EXPECT_FALSE(spec.text.pad_left);
  EXPECT_FALSE(spec.text.begin_id);
  EXPECT_FALSE(spec.text.end_id);
  EXPECT_FALSE(spec.calibration);
  EXPECT_EQ(spec.prompt_template, "{}");
  ModelFolder scale_alone = small_model();
  scale_alone.extras["logit_scale"] = "100";  // CLIP: no sigmoid loss
  EXPECT_FALSE(read_dual_encoder_spec(scale_alone).calibration);
}

TEST(DualEncoderSpec, SaysWhatIsWrong) {
  EXPECT_TRUE(contains(error_with("tokenizer", "unigram"), "sentencepiece, clip_bpe, wordpiece"));
  EXPECT_TRUE(contains(error_with("text_rule", "upper"), "none, siglip, clip, bert"));
  EXPECT_TRUE(contains(error_with("pad_side", "top"), "right, left"));
  EXPECT_TRUE(contains(error_with("pad_to_context", "maybe"), "false, true"));
  EXPECT_TRUE(contains(error_with("context_length", "12x"), "'12x'; a number"));
  EXPECT_TRUE(contains(error_with("context_length", "0"), "at least 1"));
  EXPECT_TRUE(contains(error_with("eos_id", "-2"), "'eos_id' is -2"));
  EXPECT_TRUE(contains(error_with("prompt_template", "a photo"), "needs {}"));
  EXPECT_TRUE(contains(error_with("lowercase", "true"), "sentencepiece only"));
  ModelFolder model = small_model();
  model.extras.erase("embedding_dim");
  EXPECT_TRUE(contains(error_of([&] { read_dual_encoder_spec(model); }),
                       "/models/small/model.yaml: 'embedding_dim' is missing"));
  model = small_model();
  model.input.size_px = 0;
  EXPECT_TRUE(contains(error_of([&] { read_dual_encoder_spec(model); }), "'input' is missing"));
  model = small_model();
  for (const auto& [key, value] :
       {std::pair{"context_length", "2"}, {"bos_id", "1"}, {"eos_id", "2"}})
    model.extras[key] = value;
  EXPECT_TRUE(contains(error_of([&] { read_dual_encoder_spec(model); }), "no room"));
}

TEST(OpenTokenizer, WantsItsFilesNamedAndDigested) {
  ModelFolder model = small_model();
  const TextSpec spec = read_dual_encoder_spec(model).text;
  EXPECT_TRUE(contains(error_of([&] { open_tokenizer(model, spec); }), "no digest of vocab.json"));
  model.sha256["vocab.json"] = "";
  EXPECT_TRUE(
      contains(error_of([&] { open_tokenizer(model, spec); }), "'tokenizer_merges' is missing"));
}

}  // namespace
}  // namespace ovimap
