// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/models/onnx_session.h"

#if defined(__aarch64__) && defined(__linux__)
#include <sys/auxv.h>
#endif

#include <onnxruntime_cxx_api.h>
#include <onnxruntime_session_options_config_keys.h>

#include <algorithm>
#include <string_view>
#include <thread>
#include <utility>

#include "ovimap/base/config.h"
#include "ovimap/base/error.h"
#include "ovimap/base/listed.h"
#include "ovimap/inference/models/model_folder.h"

namespace ovimap {

namespace {

const std::vector<std::pair<std::string, ExecutionProvider>>& provider_words() {
  static const std::vector<std::pair<std::string, ExecutionProvider>> words = {
      {"cpu", ExecutionProvider::kCpu},
      {"cuda", ExecutionProvider::kCuda},
      {"tensorrt", ExecutionProvider::kTensorRt},
      {"openvino", ExecutionProvider::kOpenVino},
      {"coreml", ExecutionProvider::kCoreMl}};
  return words;
}

std::string word_of(ExecutionProvider wanted) {
  for (const auto& [word, provider] : provider_words())
    if (provider == wanted) return word;
  return "";
}

std::string_view runtime_name(ExecutionProvider provider) {
  switch (provider) {
    case ExecutionProvider::kCpu:
      return "CPUExecutionProvider";
    case ExecutionProvider::kCuda:
      return "CUDAExecutionProvider";
    case ExecutionProvider::kTensorRt:
      return "TensorrtExecutionProvider";
    case ExecutionProvider::kOpenVino:
      return "OpenVINOExecutionProvider";
    case ExecutionProvider::kCoreMl:
      return "CoreMLExecutionProvider";
  }
  return "";
}

bool multiplies_int8() {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx512vnni") || __builtin_cpu_supports("avxvnni");
#elif defined(__aarch64__) && defined(__linux__)
  return (getauxval(AT_HWCAP) & HWCAP_ASIMDDP) != 0;
#else
  return false;
#endif
}

void require_available(ExecutionProvider wanted) {
  const std::vector<std::string> available = Ort::GetAvailableProviders();
  std::string accepted;
  for (const auto& [word, provider] : provider_words())
    if (std::find(available.begin(), available.end(), runtime_name(provider)) != available.end())
      accepted += (accepted.empty() ? "" : ", ") + word;
  if (std::find(available.begin(), available.end(), runtime_name(wanted)) == available.end())
    throw Error(concat("execution_provider is '", word_of(wanted),
                       "', which this ONNX Runtime lacks; it has ", accepted,
                       ". Build against an ONNX Runtime with it (tools/setup.sh --gpu fetches one "
                       "with cuda), or choose one of these"));
}

void append_provider(Ort::SessionOptions& options, ExecutionProvider provider) {
  switch (provider) {
    case ExecutionProvider::kCpu:
      break;  // always there, and what the others fall back to
    case ExecutionProvider::kCuda:
      options.AppendExecutionProvider_CUDA({});
      break;
    case ExecutionProvider::kTensorRt:
      options.AppendExecutionProvider_TensorRT({});
      break;
    case ExecutionProvider::kOpenVino:
      options.AppendExecutionProvider_OpenVINO_V2({});
      break;
    case ExecutionProvider::kCoreMl:
      options.AppendExecutionProvider("CoreML", {});
      break;
  }
}

const Ort::MemoryInfo& arena_memory() {
  static const Ort::MemoryInfo memory =
      Ort::MemoryInfo::CreateCpu(OrtArenaAllocator, OrtMemTypeDefault);
  return memory;
}

/// One arena for all networks: each of its own would keep what its largest run ever took.
void share_memory(Ort::Env& env) {
  try {
    env.CreateAndRegisterAllocator(arena_memory(), Ort::ArenaCfg(0, -1, -1, -1));
  } catch (const Ort::Exception&) {
    // Somebody else in this process registered one, which serves as well.
  }
}

Ort::Env& runtime() {
  // The runtime allows one environment a process; warnings would go to stderr, which is the
  // caller's.
  static Ort::Env env = [] {
    Ort::Env made(ORT_LOGGING_LEVEL_FATAL, "ovimap");
    share_memory(made);
    return made;
  }();
  return env;
}

std::string first_line(std::string_view text) {
  return std::string(text.substr(0, text.find('\n')));
}

/// Starts what is not always there: a driver, or libraries beside it.
void start_provider(Ort::SessionOptions& options, ExecutionProvider provider) {
  require_available(provider);
  try {
    append_provider(options, provider);
  } catch (const Ort::Exception& error) {
    throw Error(concat("execution_provider '", word_of(provider), "' does not start (",
                       first_line(error.what()),
                       "); it needs its device, the driver and the libraries that this ONNX "
                       "Runtime was built for, or choose cpu"));
  }
}

Ort::SessionOptions session_options(const RuntimeConfig& config, SessionUse use) {
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  Ort::SessionOptions options;
  options.SetIntraOpNumThreads(config.threads > 0 ? config.threads : cores);
  options.SetInterOpNumThreads(1);
  options.SetExecutionMode(ORT_SEQUENTIAL);
  options.SetGraphOptimizationLevel(ORT_ENABLE_ALL);
  options.AddConfigEntry("session.intra_op.allow_spinning", config.spin ? "1" : "0");
  options.AddConfigEntry(kOrtSessionOptionsConfigUseEnvAllocators, "1");
  if (use == SessionUse::kFewRuns)
    options.AddConfigEntry(kOrtSessionOptionsDisableSpecifiedOptimizers, "ConstantFolding");
  start_provider(options, config.execution_provider);
  return options;
}

TensorType to_type(ONNXTensorElementDataType type) {
  switch (type) {
    case ONNX_TENSOR_ELEMENT_DATA_TYPE_FLOAT:
      return TensorType::kFloat;
    case ONNX_TENSOR_ELEMENT_DATA_TYPE_INT64:
      return TensorType::kInt64;
    case ONNX_TENSOR_ELEMENT_DATA_TYPE_INT32:
      return TensorType::kInt32;
    default:
      return TensorType::kOther;
  }
}

TensorInfo to_info(std::string name, const Ort::TypeInfo& type) {
  if (type.GetONNXType() != ONNX_TYPE_TENSOR) return {std::move(name), {}, TensorType::kOther};
  const auto tensor = type.GetTensorTypeAndShapeInfo();
  return {std::move(name), tensor.GetShape(), to_type(tensor.GetElementType())};
}

Ort::Value to_value(const TensorInput& input) {
  return std::visit(
      [&input](auto values) {
        using Element = std::remove_const_t<typename decltype(values)::element_type>;
        // The runtime takes a mutable pointer but only reads inputs.
        return Ort::Value::CreateTensor<Element>(arena_memory(),
                                                 const_cast<Element*>(values.data()), values.size(),
                                                 input.shape.data(), input.shape.size());
      },
      input.values);
}

FloatTensor to_tensor(const Ort::Value& value, const std::string& name) {
  const auto info = value.GetTensorTypeAndShapeInfo();
  if (info.GetElementType() != ONNX_TENSOR_ELEMENT_DATA_TYPE_FLOAT)
    throw Error(
        concat("output ", name, " is not float32; export the network with float32 outputs"));
  const float* data = value.GetTensorData<float>();
  return {info.GetShape(), std::vector<float>(data, data + info.GetElementCount())};
}

const TensorInfo& find_tensor(const std::vector<TensorInfo>& tensors, const std::string& name,
                              std::string_view role, const std::filesystem::path& file) {
  const auto found =
      std::find_if(tensors.begin(), tensors.end(),
                   [&name](const TensorInfo& tensor) { return tensor.name == name; });
  if (found != tensors.end()) return *found;
  throw Error(concat("network ", file.string(), " has no ", role, " named '", name, "'; it has ",
                     listed(tensors, &TensorInfo::name), ". Correct the name in model.yaml"));
}

}  // namespace

struct OnnxSession::Impl {
  mutable Ort::Session session;  // Run() is thread-safe but not const
};

void list_fields(RuntimeConfig& config, ConfigFields& fields) {
  fields.add("threads", config.threads, 0, 1024, "threads of one network run (0: all cores)");
  fields.add_choice("execution_provider", config.execution_provider, provider_words(),
                    "what runs the networks; ONNX Runtime must have been built with it");
  fields.add("spin", config.spin, "idle network threads wait actively instead of sleeping");
  fields.add(
      "int8", config.int8,
      "where a model has a file for it and the processor the instructions, networks multiply "
      "bytes");
}

bool runs_in_int8(const RuntimeConfig& config) {
  return config.int8 && config.execution_provider == ExecutionProvider::kCpu && multiplies_int8();
}

OnnxSession::OnnxSession(const ModelFolder& model, const std::string& network,
                         const RuntimeConfig& config, SessionUse use)
    : OnnxSession(model.folder / model.network(network).file_for(runs_in_int8(config)), config,
                  use) {}

OnnxSession::OnnxSession(const std::filesystem::path& file, const RuntimeConfig& config,
                         SessionUse use)
    : file_(file) {
  if (!std::filesystem::is_regular_file(file))
    throw Error(concat("network file ", file.string(), " does not exist; fetch the model again"));
  try {
    Ort::Env& env = runtime();  // before the options, which log
    impl_ =
        std::make_unique<Impl>(Impl{Ort::Session(env, file.c_str(), session_options(config, use))});
    const Ort::AllocatorWithDefaultOptions allocator;
    for (std::size_t i = 0; i < impl_->session.GetInputCount(); ++i)
      inputs_.push_back(to_info(impl_->session.GetInputNameAllocated(i, allocator).get(),
                                impl_->session.GetInputTypeInfo(i)));
    for (std::size_t i = 0; i < impl_->session.GetOutputCount(); ++i)
      outputs_.push_back(to_info(impl_->session.GetOutputNameAllocated(i, allocator).get(),
                                 impl_->session.GetOutputTypeInfo(i)));
  } catch (const Ort::Exception& error) {
    throw Error(concat("network file ", file.string(), " cannot be loaded (",
                       first_line(error.what()),
                       "); fetch the model again or export it with a supported opset"));
  }
}

OnnxSession::~OnnxSession() = default;
OnnxSession::OnnxSession(OnnxSession&&) noexcept = default;
OnnxSession& OnnxSession::operator=(OnnxSession&&) noexcept = default;

const TensorInfo& OnnxSession::input(const std::string& name) const {
  return find_tensor(inputs_, name, "input", file_);
}

const TensorInfo& OnnxSession::output(const std::string& name) const {
  return find_tensor(outputs_, name, "output", file_);
}

std::string OnnxSession::metadata(const std::string& key) const {
  const Ort::AllocatorWithDefaultOptions allocator;
  const auto value =
      impl_->session.GetModelMetadata().LookupCustomMetadataMapAllocated(key.c_str(), allocator);
  return value ? value.get() : "";
}

std::vector<FloatTensor> OnnxSession::run(std::span<const TensorInput> inputs,
                                          std::span<const std::string> output_names) const {
  std::vector<const char*> input_names, wanted;
  std::vector<Ort::Value> values;
  try {
    for (const TensorInput& given : inputs) {
      input_names.push_back(given.name.c_str());
      values.push_back(to_value(given));
    }
    for (const std::string& name : output_names) wanted.push_back(name.c_str());
    const std::vector<Ort::Value> results =
        impl_->session.Run(Ort::RunOptions(nullptr), input_names.data(), values.data(),
                           values.size(), wanted.data(), wanted.size());
    std::vector<FloatTensor> tensors;
    for (std::size_t i = 0; i < results.size(); ++i)
      tensors.push_back(to_tensor(results[i], output_names[i]));
    return tensors;
  } catch (const Ort::Exception& error) {
    throw Error(concat("network ", file_.string(), " failed (", first_line(error.what()),
                       "); check that its model.yaml describes it"));
  }
}

std::string to_text(const TensorShape& shape) {
  std::string text = "[";
  for (const std::int64_t size : shape) {
    if (text.size() > 1) text += ',';
    text += size < 0 ? "any" : std::to_string(size);
  }
  return text + "]";
}

}  // namespace ovimap
