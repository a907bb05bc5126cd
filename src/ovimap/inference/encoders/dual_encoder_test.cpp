// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/encoders/dual_encoder.h"

#include <gtest/gtest.h>

#include "ovimap/inference/models/onnx_fixture.h"
#include "ovimap/inference/models/sha256.h"
#include "ovimap/inference/models/test_support.h"

namespace ovimap {
namespace {

constexpr int kSize = 4, kDimension = 3;

/// The mean colour of the normalised image, [batch, 3].
OnnxGraph image_network(std::int64_t batch) {
  OnnxGraph graph;
  graph.input("pixels", OnnxGraph::kFloat, {batch, 3, kSize, kSize})
      .node("ReduceMean", {"pixels"}, "color",
            {OnnxGraph::list_attribute("axes", {2, 3}), OnnxGraph::number_attribute("keepdims", 0)})
      .output("color", {batch, kDimension});
  return graph;
}

/// The means of ids, mask and types, [batch, 3].
OnnxGraph text_network(std::int64_t batch, std::int64_t length) {
  OnnxGraph graph;
  for (const char* name : {"ids", "mask", "types"})
    graph.input(name, OnnxGraph::kInt64, {batch, length})
        .node("Cast", {name}, concat(name, "_float"),
              {OnnxGraph::number_attribute("to", OnnxGraph::kFloat)})
        .node("ReduceMean", {concat(name, "_float")}, concat(name, "_mean"),
              {OnnxGraph::list_attribute("axes", {1}), OnnxGraph::number_attribute("keepdims", 1)});
  graph
      .node("Concat", {"ids_mean", "mask_mean", "types_mean"}, "means",
            {OnnxGraph::number_attribute("axis", 1)})
      .output("means", {batch, kDimension});
  return graph;
}

constexpr const char* kEncoderYaml = R"(kind: dual_encoder
name: tiny
license: Apache-2.0
source: a test
input: {size: 4, resize: stretch, mean: [100, 100, 100], std: [10, 10, 10]}
networks:
  image: {file: image.onnx, inputs: {image: pixels}, outputs: {embedding: color}}
  text: {file: text.onnx, inputs: {ids: ids, mask: mask, types: types}, outputs: {embedding: means}}
embedding_dim: 3
tokenizer: wordpiece
tokenizer_vocab: vocab.txt
context_length: 6
pad_to_context: true
pad_id: 0
bos_id: 2
eos_id: 3
text_rule: bert
)";

/// A model folder that can be spoilt in one place.
class EncoderFolder {
 public:
  EncoderFolder() {
    write("vocab.txt", "[PAD]\n[UNK]\n[CLS]\n[SEP]\nred\nmug\n##s\n");
    write("image.onnx", image_network(kAnySize).file());
    write("text.onnx", text_network(kAnySize, kAnySize).file());
  }
  void write(const std::string& file, const std::string& content) { scratch_.write(file, content); }
  /// Replaces `from` in model.yaml.
  void edit(const std::string& from, const std::string& to) {
    ASSERT_NE(yaml_.find(from), std::string::npos) << from;
    yaml_.replace(yaml_.find(from), from.size(), to);
  }
  const std::filesystem::path& path() const { return scratch_.path(); }

  std::unique_ptr<ImageTextEncoder> open() {
    std::string digests = "sha256: {";
    for (const char* file : {"image.onnx", "text.onnx", "vocab.txt"})
      digests += concat(file, ": ", sha256_of_file(path() / file), ", ");
    write("model.yaml", yaml_ + digests + "}\n");
    return make_image_text_encoder(path().string(), {});
  }
  std::string error() {
    return error_of([this] { open(); });
  }

 private:
  fixture::TemporaryFolder scratch_;
  std::string yaml_ = kEncoderYaml;
};

void expect_row(const Embeddings& rows, Eigen::Index row, Eigen::Vector3f direction) {
  EXPECT_LT((rows.row(row).transpose() - direction.normalized()).norm(), 1e-6f) << rows.row(row);
}

TEST(DualEncoder, EncodesImagesByTheNetwork) {
  EncoderFolder folder;
  const auto encoder = folder.open();
  std::vector<RgbImage> images;
  for (int i = 0; i < 11; ++i)  // more than one batch
    images.emplace_back(5 + i, 7, Rgb8{static_cast<std::uint8_t>(100 + i), 120, 90});
  const Embeddings rows = encoder->encode_images(images);
  ASSERT_EQ(rows.rows(), 11);
  ASSERT_EQ(rows.cols(), 3);
  for (int i = 0; i < 11; ++i) expect_row(rows, i, {static_cast<float>(i), 20.f, -10.f});
  EXPECT_EQ(encoder->encode_images({}).rows(), 0);
}

TEST(DualEncoder, EncodesTextsByTheNetwork) {
  EncoderFolder folder;
  const auto encoder = folder.open();
  const std::vector<std::string> texts = {"Red mugs", "", "mug mug mug mug mug mug mug"};
  const Embeddings rows = encoder->encode_texts(texts);
  ASSERT_EQ(rows.rows(), 3);
  expect_row(rows, 0, {2 + 4 + 5 + 6 + 3, 5, 0});  // [CLS] red mug ##s [SEP] [PAD]
  expect_row(rows, 1, {2 + 3, 2, 0});              // [CLS] [SEP] and four [PAD]
  expect_row(rows, 2, {2 + 4 * 5 + 3, 6, 0});      // cut, but [SEP] stays
}

TEST(DualEncoder, UnpaddedTextsDoNotDependOnTheirNeighbours) {
  EncoderFolder folder;
  folder.edit("pad_to_context: true", "pad_to_context: false");
  const auto encoder = folder.open();
  const std::vector<std::string> texts = {"red", "red mugs red mugs"};
  expect_row(encoder->encode_texts(texts), 0, {2 + 4 + 3, 3, 0});  // three ids, no padding
}

/// The first few texts go another way than the many that follow.
TEST(DualEncoder, FewTextsAndManyAreEncodedAlike) {
  for (const char* model : {"golden_minilm", "golden_clip", "golden_siglip"}) {
    const auto encoder = make_image_text_encoder((inference_testdata() / model).string(), {});
    const std::vector<std::string> one = {"a red mug"}, many(20, one[0]);
    const Embeddings few = encoder->encode_texts(one);
    const Embeddings rows = encoder->encode_texts(many);
    const Embeddings again = encoder->encode_texts(one);
    for (Eigen::Index row = 0; row < rows.rows(); ++row)
      EXPECT_LT((rows.row(row) - few.row(0)).norm(), 1e-5f) << model << row;
    EXPECT_LT((again.row(0) - few.row(0)).norm(), 1e-5f) << model;
  }
}

TEST(DualEncoder, TakesNetworksOfOneItem) {
  EncoderFolder folder;
  folder.write("image.onnx", image_network(1).file());
  folder.write("text.onnx", text_network(1, 6).file());
  const auto encoder = folder.open();
  const std::vector<RgbImage> images = {RgbImage(3, 3, Rgb8{110, 100, 100}),
                                        RgbImage(3, 3, Rgb8{100, 110, 100})};
  const Embeddings rows = encoder->encode_images(images);
  expect_row(rows, 0, {1, 0, 0});
  expect_row(rows, 1, {0, 1, 0});
  const std::vector<std::string> texts = {"red", "mug"};
  expect_row(encoder->encode_texts(texts), 1, {2 + 5 + 3, 3, 0});
}

TEST(DualEncoder, OnesHideNothing) {
  EncoderFolder folder;
  folder.edit("mask: mask", "ones: mask");
  const std::vector<std::string> texts = {"red"};
  expect_row(folder.open()->encode_texts(texts), 0, {2 + 4 + 3, 6, 0});  // three ids, three [PAD]
}

TEST(DualEncoder, RunsAsManyItemsAtOnceAsItsModelSays) {
  EncoderFolder folder;
  OnnxGraph graph;  // adds the mean over the batch, as a network quantised while it runs might
  graph.input("pixels", OnnxGraph::kFloat, {kAnySize, 3, kSize, kSize})
      .node("ReduceMean", {"pixels"}, "mean",
            {OnnxGraph::list_attribute("axes", {2, 3}), OnnxGraph::number_attribute("keepdims", 0)})
      .node("ReduceMean", {"mean"}, "batch",
            {OnnxGraph::list_attribute("axes", {0}), OnnxGraph::number_attribute("keepdims", 1)})
      .node("Add", {"mean", "batch"}, "color")
      .output("color", {kAnySize, kDimension});
  folder.write("image.onnx", graph.file());
  const std::vector<RgbImage> images = {RgbImage(3, 3, Rgb8{110, 100, 100}),
                                        RgbImage(3, 3, Rgb8{100, 110, 100})};
  expect_row(folder.open()->encode_images(images), 0, {3, 1, 0});
  folder.edit("text_rule: bert", "text_rule: bert\nitems_at_once: 1");
  expect_row(folder.open()->encode_images(images), 0, {1, 0, 0});
  folder.edit("items_at_once: 1", "items_at_once: 0");
  EXPECT_TRUE(contains(folder.error(), "'items_at_once' is 0"));
}

TEST(DualEncoder, WeightsBesideANetworkNeedADigest) {
  EncoderFolder folder;
  folder.write("image.onnx_data", "weights");
  EXPECT_TRUE(contains(folder.error(), "no digest of image.onnx_data"));
}

TEST(DualEncoder, RowsThatAreNotFiniteBecomeZeros) {
  EncoderFolder folder;
  OnnxGraph graph;
  graph.input("pixels", OnnxGraph::kFloat, {kAnySize, 3, kSize, kSize})
      .node("ReduceMean", {"pixels"}, "mean",
            {OnnxGraph::list_attribute("axes", {2, 3}), OnnxGraph::number_attribute("keepdims", 0)})
      .node("Sqrt", {"mean"}, "color")
      .output("color", {kAnySize, kDimension});
  folder.write("image.onnx", graph.file());
  const std::vector<RgbImage> images = {RgbImage(4, 4, Rgb8{99, 120, 120}),
                                        RgbImage(4, 4, Rgb8{110, 140, 190}),
                                        RgbImage(4, 4, Rgb8{100, 100, 100})};
  const Embeddings rows = folder.open()->encode_images(images);
  EXPECT_EQ(rows.row(0).squaredNorm(), 0.f);  // the root of a negative number
  expect_row(rows, 1, {1, 2, 3});
  EXPECT_EQ(rows.row(2).squaredNorm(), 0.f);  // no direction
}

TEST(DualEncoder, TellsWhatItIs) {
  EncoderFolder folder;
  const auto plain = folder.open();
  EXPECT_EQ(plain->identity().name, "tiny");
  EXPECT_EQ(plain->identity().dimension, 3);
  EXPECT_EQ(plain->identity().digest.size(), 64u);
  EXPECT_FALSE(plain->calibration());
  EXPECT_EQ(plain->prompt_template(), "{}");
  folder.edit("text_rule: bert",
              "text_rule: bert\nlogit_scale: 117.5\nlogit_bias: -12.25\n"
              "prompt_template: \"a photo of a {}.\"");
  const auto full = folder.open();
  EXPECT_EQ(full->identity(), plain->identity());  // the files are the same
  ASSERT_TRUE(full->calibration());
  EXPECT_EQ(full->calibration()->scale, 117.5f);
  EXPECT_EQ(full->calibration()->bias, -12.25f);
  EXPECT_EQ(full->prompt_template(), "a photo of a {}.");
  folder.write("vocab.txt", "[PAD]\n[UNK]\n[CLS]\n[SEP]\nmug\nred\n##s\n");
  EXPECT_NE(folder.open()->identity().digest, plain->identity().digest);
}

TEST(DualEncoder, DigestIsOverTheSortedFiles) {
  EncoderFolder folder;
  const auto encoder = folder.open();
  std::string lines;
  for (const char* file : {"image.onnx", "text.onnx", "vocab.txt"})
    lines += concat(file, " ", sha256_of_file(folder.path() / file), "\n");
  folder.write("lines", lines);
  EXPECT_EQ(encoder->identity().digest, sha256_of_file(folder.path() / "lines"));
}

TEST(DualEncoder, RefusesNetworksThatDoNotFit) {
  EncoderFolder size;
  size.edit("size: 4", "size: 8");
  EXPECT_TRUE(contains(size.error(), "[any,3,4,4], expected float32 [any,3,8,8]"));
  EncoderFolder dimension;
  dimension.edit("embedding_dim: 3", "embedding_dim: 5");
  EXPECT_TRUE(contains(dimension.error(), "[any,3], expected float32 [any,5]"));
  EncoderFolder batch;
  batch.write("image.onnx", image_network(2).file());
  EXPECT_TRUE(contains(batch.error(), "takes exactly 2 items"));
  EncoderFolder length;
  length.write("text.onnx", text_network(kAnySize, 9).file());
  EXPECT_TRUE(contains(length.error(), "[any,9], expected int64 [any,6]"));
  EncoderFolder name;
  name.edit("image: pixels", "image: pixel_values");
  EXPECT_TRUE(contains(name.error(), "no input named 'pixel_values'; it has pixels"));
  EncoderFolder unfed;
  unfed.edit(", types: types", "");
  EXPECT_TRUE(contains(unfed.error(), "wants an input types"));
  EncoderFolder type;
  type.edit("ids: ids, mask: mask, types: types", "ids: pixels");
  type.write("text.onnx", image_network(kAnySize).file());
  EXPECT_TRUE(contains(type.error(), "another type"));
}

TEST(DualEncoder, RefusesFilesThatChanged) {
  EncoderFolder folder;
  folder.open();
  folder.write("vocab.txt", "[UNK]\n");
  const std::string message =
      error_of([&] { make_image_text_encoder(folder.path().string(), {}); });
  EXPECT_TRUE(contains(message, "vocab.txt has SHA-256"));
}

TEST(MakeImageTextEncoder, TakesNamesAndFolders) {
  EXPECT_EQ(make_image_text_encoder("none", {}), nullptr);
  EncoderFolder folder;
  folder.open();
  const auto named =
      make_image_text_encoder(folder.path().filename().string(), {}, {folder.path().parent_path()});
  EXPECT_EQ(named->identity().name, "tiny");
}

TEST(MakeImageTextEncoder, SaysWhatIsMissing) {
  const fixture::TemporaryFolder scratch;
  const std::string absent =
      error_of([&] { make_image_text_encoder("no such model", {}, {scratch.path()}); });
  EXPECT_TRUE(contains(absent, "'no such model'"));
  EXPECT_TRUE(contains(absent, "tools/setup.sh"));
  const std::string sam = error_of(
      [] { make_image_text_encoder((inference_testdata() / "golden_entity").string(), {}); });
  EXPECT_TRUE(contains(sam, "'entity'"));
  EXPECT_TRUE(contains(sam, "dual_encoder"));
}

}  // namespace
}  // namespace ovimap
