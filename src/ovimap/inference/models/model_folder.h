// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "ovimap/image/resize.h"

namespace ovimap {

/// How an image becomes the network's square input.
enum class ResizeRule {
  kLongSide,  ///< the long side fills it, the rest is zero at the right and bottom
  kStretch,   ///< both sides fill it, the aspect ratio changes
  kShortSide  ///< the short side fills it, the long one is cut at both ends alike
};

/// The image input: value = (pixel - mean) / std with pixels from 0 to 255, channels R, G, B.
struct ImageInputSpec {
  int size_px = 0;  ///< side of the square input; 0: this model takes no image
  /// The network takes any multiple of so many rows, so those below the image need not be there; 0:
  /// it takes the square alone.
  int row_step_px = 0;
  int rows_below_px = 0;  ///< ... but for so many, which tell it where the image ends
  ResizeRule resize = ResizeRule::kLongSide;
  ResizeFilter filter = ResizeFilter::kBilinear;
  std::array<float, 3> mean = {0, 0, 0};
  std::array<float, 3> std = {255, 255, 255};
};

/// One ONNX file: what its tensors are for (the role ovimap knows) and what the file calls them.
struct NetworkSpec {
  std::string file;                            ///< relative to the model folder
  std::map<std::string, std::string> inputs;   ///< role -> tensor name
  std::map<std::string, std::string> outputs;  ///< role -> tensor name
  std::string int8_file = {};  ///< the same with products of bytes; empty: there is none

  std::vector<std::string> files() const {
    return int8_file.empty() ? std::vector{file} : std::vector{file, int8_file};
  }
  /// The file to run.
  const std::string& file_for(bool in_int8) const {
    return in_int8 && !int8_file.empty() ? int8_file : file;
  }
};

/// A model folder's model.yaml.
struct ModelFolder {
  std::filesystem::path folder;
  std::string kind;  ///< "sam", "entity", "dual_encoder"
  std::string name, license, source;
  ImageInputSpec input;
  std::map<std::string, NetworkSpec> networks;
  std::map<std::string, std::string> sha256;  ///< file -> 64 hexadecimal digits
  std::map<std::string, std::string>
      extras;  ///< every other scalar key, for the model's kind to read

  /// Throws Error when model.yaml describes no network of that name.
  const NetworkSpec& network(const std::string& network_name) const;
  /// The tensor that plays `role`. Throws Error when model.yaml does not say.
  const std::string& input_of(const std::string& network_name, const std::string& role) const;
  const std::string& output_of(const std::string& network_name, const std::string& role) const;
  /// One of the extras; empty: there is none.
  std::string extra(const std::string& key) const;
  /// SHA-256 over the lines "file digest" in the order of the files' names: which build it is.
  std::string digest() const;
};

/// Reads `folder`/model.yaml. Throws Error naming the file and what is missing or wrong in it.
ModelFolder read_model_folder(const std::filesystem::path& folder);

/// Checks that every file the model names exists and has the SHA-256 digest model.yaml gives.
/// Throws Error naming the first file that does not, with both digests.
void verify_model_files(const ModelFolder& model);
/// The same for those of its files whose name `wanted` accepts.
void verify_model_files(const ModelFolder& model,
                        const std::function<bool(const std::string& file)>& wanted);
/// The model itself when it is of `kind` and its files are verified. Throws Error otherwise; `use`
/// says what it was wanted for: "as a promptable network".
const ModelFolder& checked_model(const ModelFolder& model, const std::string& kind,
                                 const std::string& use);

/// Where models are looked for, in this order: `model_dirs`, the folders of $OVIMAP_MODELS
/// (separated by colons), `.models` in the working folder and in each folder above the program, and
/// the user's data folder (~/.local/share/ovimap/models). Only folders that exist, each once.
std::vector<std::filesystem::path> model_search_path(
    const std::vector<std::filesystem::path>& model_dirs = {});

/// The user's data folder for models, which need not exist; none where there is no home.
std::optional<std::filesystem::path> user_model_folder();

/// A folder on the search path that holds a model.yaml.
struct ModelListing {
  std::filesystem::path folder;
  std::string name;       ///< the folder's name: what `--masks NAME` takes
  std::string kind;       ///< empty when model.yaml cannot be read
  std::string fault;      ///< why model.yaml cannot be read; empty when it can
  int preference = 0;     ///< of encoders: `auto` takes the greatest; model.yaml's key
  std::string variant;    ///< of a fetched model: full, fp16 or quantized
  bool doubtful = false;  ///< its self-test said that it may be wrong
};

/// All models on the search path, the first of each name only, sorted by name within a folder.
std::vector<ModelListing> list_models(const std::vector<std::filesystem::path>& search_path);

/// The folder of the model that a user calls `name`: a folder that holds one, or a model's name on
/// the search path. Throws as find_model.
std::filesystem::path named_model(const std::string& name,
                                  const std::vector<std::filesystem::path>& search_path);

/// The folder of the model called `name`. Throws Error with the folders searched when there is
/// none, and the model or word of `known` (what else is accepted in its place) that was meant.
std::filesystem::path find_model(const std::string& name,
                                 const std::vector<std::filesystem::path>& search_path,
                                 std::vector<std::string> known = {});

}  // namespace ovimap
