// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace ovimap {

class ConfigFields;
struct ModelFolder;

enum class ExecutionProvider { kCpu, kCuda, kTensorRt, kOpenVino, kCoreMl };

/// How networks are executed.
struct RuntimeConfig {
  int threads = 0;  ///< threads of one network run (0: all cores); the mapper runs beside it
  ExecutionProvider execution_provider = ExecutionProvider::kCpu;
  bool spin = false;  ///< idle threads wait actively: a little faster alone, slower beside others
  bool int8 = true;   ///< products of bytes, where the model has a file for it and the processor
                      ///< the instructions
};
void list_fields(RuntimeConfig& config, ConfigFields& fields);

/// Whether the files with products of bytes are run (NetworkSpec::file_for): on processors that add
/// four products of bytes at once. Others add two, in 16 bits, which overflow, or are no quicker.
bool runs_in_int8(const RuntimeConfig& config);

/// Dimensions of a tensor; kAnySize where the network leaves one open.
using TensorShape = std::vector<std::int64_t>;
inline constexpr std::int64_t kAnySize = -1;

enum class TensorType { kFloat, kInt64, kInt32, kOther };

/// An input or output as the network file declares it.
struct TensorInfo {
  std::string name;
  TensorShape shape;
  TensorType type = TensorType::kFloat;
};

/// A named input; the values are only borrowed for the call.
struct TensorInput {
  std::string name;
  TensorShape shape;
  std::variant<std::span<const float>, std::span<const std::int64_t>, std::span<const std::int32_t>>
      values;
};

struct FloatTensor {
  TensorShape shape;
  std::vector<float> values;
};

/// How often a network will be run. For a few runs its weights are left as the file has them, half
/// as many bytes for instance, and converted at each run: it opens in a third of the time.
enum class SessionUse { kManyRuns, kFewRuns };

/// One ONNX file ready to run. Running is thread-safe.
class OnnxSession {
 public:
  /// Throws Error when the file is missing or not an ONNX network, or when the configured execution
  /// provider is not in this ONNX Runtime (the message lists those that are).
  OnnxSession(const std::filesystem::path& file, const RuntimeConfig& config,
              SessionUse use = SessionUse::kManyRuns);
  /// The network of that name of a model. Throws as above, and where the model has none.
  OnnxSession(const ModelFolder& model, const std::string& network, const RuntimeConfig& config,
              SessionUse use = SessionUse::kManyRuns);
  ~OnnxSession();
  OnnxSession(OnnxSession&&) noexcept;
  OnnxSession& operator=(OnnxSession&&) noexcept;

  const std::vector<TensorInfo>& inputs() const { return inputs_; }
  const std::vector<TensorInfo>& outputs() const { return outputs_; }

  /// The declared input or output of that name. Throws Error naming the file, the missing name and
  /// the names there are.
  const TensorInfo& input(const std::string& name) const;
  const TensorInfo& output(const std::string& name) const;

  /// What the file says under that key of its metadata; empty when it says nothing.
  std::string metadata(const std::string& key) const;

  /// The wanted float outputs, in the order of `output_names`. Throws Error with the runtime's
  /// reason when the network cannot be run on these inputs.
  std::vector<FloatTensor> run(std::span<const TensorInput> inputs,
                               std::span<const std::string> output_names) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
  std::filesystem::path file_;
  std::vector<TensorInfo> inputs_, outputs_;
};

/// "[1,3,any,any]", for messages.
std::string to_text(const TensorShape& shape);

}  // namespace ovimap
