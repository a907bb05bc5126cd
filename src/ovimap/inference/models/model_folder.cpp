// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/models/model_folder.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "ovimap/base/bounded_yaml.h"
#include "ovimap/base/error.h"
#include "ovimap/inference/models/sha256.h"

namespace ovimap {

namespace fs = std::filesystem;

namespace {

constexpr const char* kModelFile = "model.yaml";
constexpr int kLargestInput_px = 4096;

[[noreturn]] void fault(const fs::path& folder, const std::string& what) {
  throw Error(concat("model file ", (folder / kModelFile).string(), ": ", what));
}

std::string required_text(const YAML::Node& node, const char* key, const fs::path& folder) {
  if (!node[key] || !node[key].IsScalar()) fault(folder, concat("'", key, "' is missing; add it"));
  return node[key].as<std::string>();
}

std::map<std::string, std::string> text_map(const YAML::Node& node) {
  std::map<std::string, std::string> map;
  for (const auto& entry : node)
    map[entry.first.as<std::string>()] = entry.second.as<std::string>();
  return map;
}

std::array<float, 3> three_numbers(const YAML::Node& node, const char* key,
                                   const fs::path& folder) {
  const YAML::Node values = node[key];
  if (!values || !values.IsSequence() || values.size() != 3)
    fault(folder, concat("'input.", key, "' must be three numbers, for red, green and blue"));
  return {values[0].as<float>(), values[1].as<float>(), values[2].as<float>()};
}

/// The value of `key` in `words`; `otherwise` where the key is absent.
template <class Value>
Value word_of(const YAML::Node& node, const char* key, const std::map<std::string, Value>& words,
              std::optional<Value> otherwise, const fs::path& folder) {
  if (otherwise && !node[key]) return *otherwise;
  const std::string given = required_text(node, key, folder);
  const auto found = words.find(given);
  if (found != words.end()) return found->second;
  std::string accepted;
  for (const auto& [word, value] : words) accepted += (accepted.empty() ? "" : " or ") + word;
  fault(folder, concat("'input.", key, "' is '", given, "'; accepted is ", accepted));
}

ImageInputSpec parse_input(const YAML::Node& node, const std::string& kind,
                           const fs::path& folder) {
  // Masks are mapped back onto the whole image, so only encoders may cut parts of it off.
  std::map<std::string, ResizeRule> rules = {{"long_side", ResizeRule::kLongSide},
                                             {"stretch", ResizeRule::kStretch}};
  if (kind == "dual_encoder") rules["short_side"] = ResizeRule::kShortSide;
  static const std::map<std::string, ResizeFilter> filters = {{"bilinear", ResizeFilter::kBilinear},
                                                              {"bicubic", ResizeFilter::kBicubic}};
  ImageInputSpec spec;
  spec.size_px = node["size"] ? node["size"].as<int>() : 0;
  if (spec.size_px < 1 || spec.size_px > kLargestInput_px)
    fault(folder, concat("'input.size' must be the side of the input in pixels, at most ",
                         kLargestInput_px));
  const auto pixels = [&](const char* key) {
    const int value = node[key] ? node[key].as<int>() : 0;
    if (value < 0 || value > spec.size_px)
      fault(folder, concat("'input.", key, "' must be a number of pixels up to 'input.size'"));
    return value;
  };
  spec.row_step_px = pixels("row_step");
  spec.rows_below_px = pixels("rows_below");
  spec.resize = word_of<ResizeRule>(node, "resize", rules, {}, folder);
  spec.filter = word_of<ResizeFilter>(node, "filter", filters, ResizeFilter::kBilinear, folder);
  spec.mean = three_numbers(node, "mean", folder);
  spec.std = three_numbers(node, "std", folder);
  const auto finite = [](float value) { return std::isfinite(value); };
  if (!std::all_of(spec.mean.begin(), spec.mean.end(), finite) ||
      !std::all_of(spec.std.begin(), spec.std.end(), finite) ||
      *std::min_element(spec.std.begin(), spec.std.end()) <= 0)
    fault(folder, "'input.mean' and 'input.std' must be finite, and 'input.std' positive");
  return spec;
}

void require_inside(const std::string& file, const fs::path& folder) {
  if (fs::path(file).is_absolute() || file.find("..") != std::string::npos)
    fault(folder, concat("network file '", file, "' must lie inside the model folder"));
}

NetworkSpec parse_network(const YAML::Node& node, const fs::path& folder) {
  NetworkSpec network{required_text(node, "file", folder), text_map(node["inputs"]),
                      text_map(node["outputs"])};
  if (node["int8_file"]) network.int8_file = required_text(node, "int8_file", folder);
  for (const std::string& file : network.files()) require_inside(file, folder);
  return network;
}

/// A network's file and the weights that ONNX keeps beside it: "net.onnx", "net.onnx.data" or
/// "net.onnx_data".
std::vector<std::string> files_of(const fs::path& folder, const std::string& file) {
  std::vector<std::string> files = {file};
  std::error_code unreadable;
  const fs::path path = folder / file;
  for (const auto& entry : fs::directory_iterator(path.parent_path(), unreadable)) {
    const std::string name = entry.path().filename().string();
    const std::string network = path.filename().string();
    if (name.starts_with(network + ".") || name.starts_with(network + "_data"))
      files.push_back((fs::path(file).parent_path() / name).string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

ModelFolder parse(const YAML::Node& root, const fs::path& folder) {
  if (!root.IsMap()) fault(folder, "it must be a list of 'key: value' lines");
  ModelFolder model;
  model.folder = folder;
  model.kind = required_text(root, "kind", folder);
  model.name = required_text(root, "name", folder);
  model.license = required_text(root, "license", folder);
  model.source = required_text(root, "source", folder);
  if (root["input"]) model.input = parse_input(root["input"], model.kind, folder);
  for (const auto& entry : root["networks"])
    model.networks[entry.first.as<std::string>()] = parse_network(entry.second, folder);
  model.sha256 = text_map(root["sha256"]);
  for (const auto& [name, network] : model.networks)
    for (const std::string& of_network : network.files())
      for (const std::string& file : files_of(folder, of_network))
        if (!model.sha256.contains(file))
          fault(folder, concat("'sha256' has no digest of ", file, "; add it"));
  static const std::set<std::string> known = {"kind", "name", "license", "source"};
  for (const auto& entry : root)
    if (entry.second.IsScalar() && !known.contains(entry.first.as<std::string>()))
      model.extras[entry.first.as<std::string>()] = entry.second.as<std::string>();
  return model;
}

const std::string& tensor_of(const ModelFolder& model, const std::string& network_name,
                             const std::map<std::string, std::string>& tensors,
                             const char* role_kind, const std::string& role) {
  const auto found = tensors.find(role);
  if (found == tensors.end())
    fault(model.folder, concat("'networks.", network_name, ".", role_kind, ".", role,
                               "' is missing; add the tensor's name"));
  return found->second;
}

}  // namespace

const NetworkSpec& ModelFolder::network(const std::string& network_name) const {
  const auto found = networks.find(network_name);
  if (found == networks.end())
    fault(folder,
          concat("'networks.", network_name, "' is missing; a model of kind ", kind, " needs it"));
  return found->second;
}

const std::string& ModelFolder::input_of(const std::string& network_name,
                                         const std::string& role) const {
  return tensor_of(*this, network_name, network(network_name).inputs, "inputs", role);
}

const std::string& ModelFolder::output_of(const std::string& network_name,
                                          const std::string& role) const {
  return tensor_of(*this, network_name, network(network_name).outputs, "outputs", role);
}

std::string ModelFolder::extra(const std::string& key) const {
  const auto found = extras.find(key);
  return found == extras.end() ? std::string() : found->second;
}

std::string ModelFolder::digest() const {
  Sha256 sum;
  for (const auto& [file, file_digest] : sha256) {
    const std::string line = concat(file, " ", file_digest, "\n");
    sum.update({reinterpret_cast<const std::uint8_t*>(line.data()), line.size()});
  }
  return sum.finish();
}

ModelFolder read_model_folder(const fs::path& folder) {
  const fs::path file = folder / kModelFile;
  if (!fs::is_regular_file(file))
    throw Error(concat("model folder ", folder.string(), " has no ", kModelFile,
                       "; name a folder that tools/setup.sh or the export tool wrote"));
  try {
    return parse(read_yaml(file, kSmallDocument), folder);
  } catch (const YAML::Exception& error) {
    fault(folder, concat("line ", error.mark.line + 1, ": ", error.msg));
  }
}

const ModelFolder& checked_model(const ModelFolder& model, const std::string& kind,
                                 const std::string& use) {
  if (model.kind != kind)
    throw Error(concat("model ", model.folder.string(), " is of kind '", model.kind, "'; ", use,
                       " only kind ", kind, " is accepted"));
  verify_model_files(model);
  return model;
}

void verify_model_files(const ModelFolder& model) {
  verify_model_files(model, [](const std::string&) { return true; });
}

void verify_model_files(const ModelFolder& model,
                        const std::function<bool(const std::string& file)>& wanted) {
  for (const auto& [name, expected] : model.sha256) {
    if (!wanted(name)) continue;
    const fs::path file = model.folder / name;
    if (!fs::is_regular_file(file))
      throw Error(concat("model file ", file.string(), " does not exist; fetch the model again"));
    const std::string found = sha256_of_file(file);
    if (found != expected)
      throw Error(concat("model file ", file.string(), " has SHA-256 ", found,
                         ", but model.yaml gives ", expected, "; fetch the model again"));
  }
}

}  // namespace ovimap
