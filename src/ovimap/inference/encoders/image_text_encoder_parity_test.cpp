// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// Small models with random weights against what the Hugging Face pipelines made of them
// (tools/models/make_golden_encoders.py).
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "ovimap/image/codec.h"
#include "ovimap/inference/encoders/dual_encoder_spec.h"
#include "ovimap/inference/encoders/image_text_encoder.h"
#include "ovimap/inference/models/test_support.h"
#include "ovimap/inference/text/text_input.h"

namespace ovimap {
namespace {

constexpr double kMinCosine = 0.9999;

struct GoldenText {
  std::string text;
  std::vector<std::int64_t> ids;
};

std::vector<GoldenText> read_texts(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::vector<GoldenText> texts;
  for (const auto& entry : nlohmann::json::parse(in))
    texts.push_back({entry.at("text"), entry.at("ids").get<std::vector<std::int64_t>>()});
  return texts;
}

/// All numbers of a file as rows of `dimension`, each with length 1.
Embeddings read_rows(const std::filesystem::path& file, int dimension) {
  std::ifstream in(file);
  std::vector<float> values;
  for (float value; in >> value;) values.push_back(value);
  const auto rows = static_cast<Eigen::Index>(values.size()) / dimension;
  Embeddings expected = Eigen::Map<const Embeddings>(values.data(), rows, dimension);
  expected.rowwise().normalize();
  return expected;
}

double cosine(const Embeddings& a, const Embeddings& b, Eigen::Index row) {
  return a.row(row).cast<double>().dot(b.row(row).cast<double>());
}

class ImageTextEncoderParity : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    folder_ = inference_testdata() / (std::string("golden_") + GetParam());
    ASSERT_TRUE(std::filesystem::is_regular_file(folder_ / "model.yaml")) << folder_;
    encoder_ = make_image_text_encoder(folder_.string(), {});
  }
  std::filesystem::path folder_;
  std::unique_ptr<ImageTextEncoder> encoder_;
};

TEST_P(ImageTextEncoderParity, ImagesGiveTheSameEmbedding) {
  const std::vector<RgbImage> images = {read_rgb(folder_ / "image.png")};
  const Embeddings found = encoder_->encode_images(images);
  const Embeddings expected =
      read_rows(folder_ / "expected_image.txt", encoder_->identity().dimension);
  ASSERT_EQ(expected.rows(), 1);
  EXPECT_GE(cosine(found, expected, 0), kMinCosine);
}

TEST_P(ImageTextEncoderParity, TextsGiveTheSameEmbeddings) {
  const Embeddings expected =
      read_rows(folder_ / "expected_text.txt", encoder_->identity().dimension);
  ASSERT_GE(expected.rows(), 8);
  std::vector<std::string> texts;
  for (const GoldenText& golden : read_texts(folder_ / "texts.json")) texts.push_back(golden.text);
  texts.resize(static_cast<std::size_t>(expected.rows()));
  const Embeddings found = encoder_->encode_texts(texts);
  for (Eigen::Index i = 0; i < expected.rows(); ++i)
    EXPECT_GE(cosine(found, expected, i), kMinCosine) << texts[static_cast<std::size_t>(i)];
}

TEST_P(ImageTextEncoderParity, TextsGiveTheSameIds) {
  const ModelFolder model = read_model_folder(folder_);
  const TextSpec spec = read_dual_encoder_spec(model).text;
  const auto tokenizer = open_tokenizer(model, spec);
  const std::vector<GoldenText> texts = read_texts(folder_ / "texts.json");
  EXPECT_GE(texts.size(), 200u);
  for (const GoldenText& golden : texts)
    EXPECT_EQ(make_id_batch({&golden.text, 1}, spec, *tokenizer).ids, golden.ids)
        << nlohmann::json(golden.text.substr(0, 200))
               .dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
}

INSTANTIATE_TEST_SUITE_P(Models, ImageTextEncoderParity,
                         testing::Values("siglip", "siglip2", "clip", "minilm"),
                         [](const auto& run) { return std::string(run.param); });

}  // namespace
}  // namespace ovimap
