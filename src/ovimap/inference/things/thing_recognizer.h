// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "ovimap/image/image.h"
#include "ovimap/inference/models/onnx_session.h"

namespace ovimap {

/// Which things a recognizer tells, in the order of its answers.
struct RecognizerIdentity {
  std::string name;                 ///< of its networks; empty: there is none
  std::vector<std::string> things;  ///< each in words for it, separated by | ("cup|mug")
  bool operator==(const RecognizerIdentity&) const = default;
};

/// What was recognized in one picture. Immutable.
class ThingsInPicture {
 public:
  virtual ~ThingsInPicture() = default;
  /// [things] how much more probable what was found there is of that thing than of others, as
  /// logarithm. `box`: of an object, as shares of the picture's sides.
  virtual Eigen::VectorXf log_ratios(const Eigen::AlignedBox2f& box) const = 0;
};

/// Tells things by name that it was trained on. Calls are thread-safe.
class ThingRecognizer {
 public:
  virtual ~ThingRecognizer() = default;
  virtual const RecognizerIdentity& identity() const = 0;
  /// The whole picture, so that things are seen with what is around them. Throws Error when a
  /// network fails.
  virtual std::unique_ptr<const ThingsInPicture> look(const RgbImage& picture) const = 0;
};

/// What `spec` names: "none" (nullptr), "auto" (every model of kind detector on the search path;
/// nullptr where there is none), or models by name or folder, separated by commas. Throws Error
/// when there is no such model, or it does not load.
std::unique_ptr<ThingRecognizer> make_thing_recognizer(
    const std::string& spec, const RuntimeConfig& runtime,
    const std::vector<std::filesystem::path>& model_dirs = {});

}  // namespace ovimap
