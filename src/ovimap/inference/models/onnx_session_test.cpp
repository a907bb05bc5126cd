// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/models/onnx_session.h"

#include <gtest/gtest.h>

#include "ovimap/base/config.h"
#include "ovimap/inference/models/test_support.h"

namespace ovimap {
namespace {

std::filesystem::path encoder_file() {
  return inference_testdata() / "golden_sam/batched/encoder.onnx";
}

TEST(OnnxSession, TellsInputsAndOutputs) {
  const OnnxSession session(encoder_file(), {});
  EXPECT_EQ(session.input("image").shape, (TensorShape{1, 3, 64, 64}));
  EXPECT_EQ(session.output("embedding").shape, (TensorShape{1, 3, 16, 16}));
  const std::string message = error_of([&] { session.output("masks"); });
  EXPECT_TRUE(contains(message, "no output named 'masks'; it has embedding")) << message;
}

// The encoder averages cells of 4 x 4.
TEST(OnnxSession, Runs) {
  const OnnxSession session(encoder_file(), {});
  std::vector<float> image(3 * 64 * 64, 0.f);
  image[0] = 16.f;
  const std::vector<TensorInput> inputs = {
      {"image", {1, 3, 64, 64}, std::span<const float>(image)}};
  const std::vector<std::string> outputs = {"embedding"};
  const auto results = session.run(inputs, outputs);
  ASSERT_EQ(results.size(), 1u);
  EXPECT_EQ(results[0].shape, (TensorShape{1, 3, 16, 16}));
  EXPECT_FLOAT_EQ(results[0].values[0], 1.f);
  EXPECT_FLOAT_EQ(results[0].values[1], 0.f);
}

TEST(OnnxSession, WrongInputIsAnErrorNamingTheFile) {
  const OnnxSession session(encoder_file(), {});
  const std::vector<float> image(3 * 32 * 32, 0.f);
  const std::vector<TensorInput> inputs = {
      {"image", {1, 3, 32, 32}, std::span<const float>(image)}};
  const std::vector<std::string> outputs = {"embedding"};
  EXPECT_TRUE(contains(error_of([&] { session.run(inputs, outputs); }), "encoder.onnx failed"));
}

TEST(OnnxSession, BadFilesAreNamed) {
  const fixture::TemporaryFolder scratch;
  EXPECT_TRUE(
      contains(error_of([&] { OnnxSession(scratch.path() / "no.onnx", {}); }), "does not exist"));
  scratch.write("text.onnx", "this is not a network");
  const std::string message = error_of([&] { OnnxSession(scratch.path() / "text.onnx", {}); });
  EXPECT_TRUE(contains(message, "text.onnx cannot be loaded")) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos);
}

TEST(OnnxSession, MissingProviderListsThoseThere) {
  RuntimeConfig config;
  config.execution_provider = ExecutionProvider::kCoreMl;  // exists on another system only
  const std::string message = error_of([&] { OnnxSession(encoder_file(), config); });
  EXPECT_TRUE(contains(message, "execution_provider is 'coreml'")) << message;
  EXPECT_TRUE(contains(message, "it has cpu")) << message;
}

TEST(RuntimeConfig, ReadsProviderWords) {
  RuntimeConfig config;
  ConfigFields fields;
  list_fields(config, fields);
  fields.set("execution_provider", "openvino");
  fields.set("threads", "3");
  EXPECT_EQ(config.execution_provider, ExecutionProvider::kOpenVino);
  EXPECT_EQ(config.threads, 3);
  EXPECT_THROW(fields.set("execution_provider", "abacus"), Error);
}

TEST(RuntimeConfig, MultipliesBytesOnlyWhereItMayAndOnProcessors) {
  RuntimeConfig config;
  const bool here = runs_in_int8(config);  // as this processor has it
  config.execution_provider = ExecutionProvider::kCuda;
  EXPECT_FALSE(runs_in_int8(config));
  config.execution_provider = ExecutionProvider::kCpu;
  EXPECT_EQ(runs_in_int8(config), here);
  config.int8 = false;
  EXPECT_FALSE(runs_in_int8(config));
}

TEST(TensorShape, ReadsWell) {
  EXPECT_EQ(to_text(TensorShape{1, kAnySize, 2}), "[1,any,2]");
}

}  // namespace
}  // namespace ovimap
