// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/models/model_folder.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "ovimap/inference/models/sha256.h"
#include "ovimap/inference/models/test_support.h"

namespace ovimap {
namespace {

namespace fs = std::filesystem;

constexpr const char* kYaml = R"(kind: sam
name: test model
license: Apache-2.0
source: nowhere
embedding_dimension: 384
input: {size: 64, resize: stretch, mean: [1, 2, 3], std: [4, 5, 6]}
networks:
  encoder: {file: encoder.onnx, inputs: {image: input}, outputs: {embedding: output}}
sha256: {encoder.onnx: ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad}
)";

/// kYaml with `from` replaced by `to`.
std::string edited(const std::string& from, const std::string& to) {
  std::string text = kYaml;
  return text.replace(text.find(from), from.size(), to);
}

TEST(ModelFolder, ReadsEveryPart) {
  const fixture::TemporaryFolder scratch;
  scratch.write("model.yaml", kYaml);
  const ModelFolder model = read_model_folder(scratch.path());
  EXPECT_EQ(model.kind, "sam");
  EXPECT_EQ(model.name, "test model");
  EXPECT_EQ(model.input.size_px, 64);
  EXPECT_EQ(model.input.resize, ResizeRule::kStretch);
  EXPECT_EQ(model.input.filter, ResizeFilter::kBilinear);
  EXPECT_EQ(model.input.mean, (std::array<float, 3>{1, 2, 3}));
  EXPECT_EQ(model.input.std, (std::array<float, 3>{4, 5, 6}));
  EXPECT_EQ(model.input_of("encoder", "image"), "input");
  EXPECT_EQ(model.output_of("encoder", "embedding"), "output");
  EXPECT_EQ(model.extras.at("embedding_dimension"), "384");
}

TEST(ModelFolder, SaysWhatIsWrong) {
  const fixture::TemporaryFolder scratch;
  EXPECT_TRUE(contains(error_of([&] { read_model_folder(scratch.path()); }), "has no model.yaml"));
  const auto message = [&](const std::string& text) {
    scratch.write("model.yaml", text);
    return error_of([&] { read_model_folder(scratch.path()); });
  };
  EXPECT_TRUE(contains(message(edited("kind: sam", "kid: sam")), "'kind' is missing"));
  EXPECT_TRUE(contains(message(edited("stretch", "crop")), "accepted is long_side or stretch"));
  EXPECT_TRUE(contains(message(edited("size: 64", "size: 64, row_step: 65")), "'input.row_step'"));
  for (const char* size : {"size: 0", "size: 4097", "size: 2147483647"})
    EXPECT_TRUE(contains(message(edited("size: 64", size)), "at most 4096")) << size;
  for (const char* std : {"std: [.nan, 1, 1]", "std: [.inf, 1, 1]", "std: [0, 1, 1]"})
    EXPECT_TRUE(contains(message(edited("std: [4, 5, 6]", std)), "must be finite")) << std;
  EXPECT_TRUE(contains(message(edited("[1, 2, 3]", "[1, 2]")), "three numbers"));
  EXPECT_TRUE(contains(message(edited("[4, 5, 6]", "[4, 0, 6]")), "positive"));
  EXPECT_TRUE(contains(message(edited("file: encoder", "file: ../encoder")), "inside the model"));
  EXPECT_TRUE(
      contains(message(edited("{encoder.onnx: b", "{other.onnx: b")), "no digest of encoder"));
  EXPECT_TRUE(contains(message("kind: [unclosed"), "line "));
  for (const std::string& text : {std::string("- a"), std::string("text")})
    EXPECT_TRUE(contains(message(text), "key: value"));
}

TEST(ModelFolder, ReadsTheFileOfBytes) {
  const fixture::TemporaryFolder scratch;
  const std::string with =
      edited("file: encoder.onnx", "file: encoder.onnx, int8_file: encoder-int8.onnx");
  const auto message = [&](const std::string& text) {
    scratch.write("model.yaml", text);
    return error_of([&] { read_model_folder(scratch.path()); });
  };
  EXPECT_TRUE(contains(message(with), "no digest of encoder-int8.onnx"));
  EXPECT_TRUE(contains(message(edited("file: encoder.onnx", "file: a.onnx, int8_file: ../b.onnx")),
                       "'../b.onnx' must lie inside the model"));

  scratch.write("model.yaml", kYaml);
  EXPECT_EQ(read_model_folder(scratch.path()).network("encoder").file_for(true), "encoder.onnx");
  std::string whole = with;
  whole.insert(whole.find("{encoder.onnx: ") + 1,
               "encoder-int8.onnx: " + std::string(64, '0') + ", ");
  scratch.write("model.yaml", whole);
  const ModelFolder model = read_model_folder(scratch.path());
  EXPECT_EQ(model.network("encoder").file_for(true), "encoder-int8.onnx");
  EXPECT_EQ(model.network("encoder").file_for(false), "encoder.onnx");
}

TEST(ModelFolder, OnlyEncodersMayCutImages) {
  const fixture::TemporaryFolder scratch;
  std::string text = edited("kind: sam", "kind: dual_encoder");
  text.replace(text.find("stretch"), 7, "short_side, filter: bicubic");
  scratch.write("model.yaml", text);
  const ModelFolder model = read_model_folder(scratch.path());
  EXPECT_EQ(model.input.resize, ResizeRule::kShortSide);
  EXPECT_EQ(model.input.filter, ResizeFilter::kBicubic);
  scratch.write("model.yaml", edited("stretch", "short_side"));
  EXPECT_TRUE(contains(error_of([&] { read_model_folder(scratch.path()); }),
                       "'short_side'; accepted is long_side or stretch"));
  scratch.write("model.yaml", edited("stretch", "stretch, filter: lanczos"));
  EXPECT_TRUE(contains(error_of([&] { read_model_folder(scratch.path()); }),
                       "accepted is bicubic or bilinear"));
}

TEST(ModelFolder, NamesMissingRoles) {
  const fixture::TemporaryFolder scratch;
  scratch.write("model.yaml", kYaml);
  const ModelFolder model = read_model_folder(scratch.path());
  EXPECT_TRUE(
      contains(error_of([&] { model.network("decoder"); }), "'networks.decoder' is missing"));
  EXPECT_TRUE(contains(error_of([&] { model.output_of("encoder", "masks"); }),
                       "'networks.encoder.outputs.masks' is missing"));
}

TEST(ModelFolder, VerifiesDigests) {
  const fixture::TemporaryFolder scratch;
  scratch.write("model.yaml", kYaml);
  const ModelFolder model = read_model_folder(scratch.path());
  EXPECT_TRUE(
      contains(error_of([&] { verify_model_files(model); }), "encoder.onnx does not exist"));
  scratch.write("encoder.onnx", "abc");  // whose digest is the standard's example
  EXPECT_NO_THROW(verify_model_files(model));
  scratch.write("encoder.onnx", "abd");
  EXPECT_TRUE(contains(error_of([&] { verify_model_files(model); }),
                       sha256_of_file(scratch.path() / "encoder.onnx")));
}

TEST(ModelSearch, TakesDirsThenEnvironmentOnceEach) {
  const fixture::TemporaryFolder scratch;
  for (const char* place : {"first", "second", "third"})
    fs::create_directories(scratch.path() / place);
  const std::string list = (scratch.path() / "second").string() + ":" +
                           (scratch.path() / "first").string() + ":" +
                           (scratch.path() / "absent").string();
  ::setenv("OVIMAP_MODELS", list.c_str(), 1);
  const std::vector<fs::path> found = model_search_path({scratch.path() / "first"});
  ::unsetenv("OVIMAP_MODELS");
  ASSERT_GE(found.size(), 2u);
  EXPECT_EQ(found[0], scratch.path() / "first");
  EXPECT_EQ(found[1], scratch.path() / "second");
  for (std::size_t i = 2; i < found.size(); ++i) EXPECT_NE(found[i].parent_path(), scratch.path());
}

TEST(ModelSearch, ListsTheFirstOfEachName) {
  const fixture::TemporaryFolder scratch;
  scratch.write("a/good/model.yaml", kYaml);
  scratch.write("b/good/model.yaml", edited("kind: sam", "kind: entity"));
  scratch.write("b/broken/model.yaml", "kind: sam\n");
  scratch.write("b/no_model/readme.txt", "");
  const auto models = list_models({scratch.path() / "a", scratch.path() / "b"});
  ASSERT_EQ(models.size(), 2u);
  EXPECT_EQ(models[0].name, "good");
  EXPECT_EQ(models[0].kind, "sam");
  EXPECT_TRUE(models[0].fault.empty());
  EXPECT_EQ(models[1].name, "broken");
  EXPECT_TRUE(contains(models[1].fault, "'name' is missing"));
  EXPECT_EQ(find_model("broken", {scratch.path() / "a", scratch.path() / "b"}),
            scratch.path() / "b" / "broken");
}

TEST(ModelSearch, SaysWhereItLooked) {
  const fixture::TemporaryFolder scratch;
  const std::string message = error_of([&] { find_model("absent", {scratch.path()}); });
  EXPECT_TRUE(contains(message, "'absent'"));
  EXPECT_TRUE(contains(message, scratch.path().string()));
  EXPECT_TRUE(contains(message, "tools/setup.sh"));
}

}  // namespace
}  // namespace ovimap
