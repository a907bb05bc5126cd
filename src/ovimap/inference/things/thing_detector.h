// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "ovimap/inference/models/model_folder.h"
#include "ovimap/inference/models/onnx_session.h"
#include "ovimap/inference/things/thing_recognizer.h"

namespace ovimap {

/// How likely a detector's score is for things of a name beside that for others: the log ratio is
/// offset + slope * log((score + floor) / (background + floor)). docs/default-encoder.md says how
/// the numbers were found.
struct ScoreRatio {
  float floor = 0.03f, slope = 1.f, offset = 0.f;
  float log_ratio(float score, float background) const;
};

/// A network that finds boxes in a picture and scores each for every name that it knows.
class ThingDetector {
 public:
  using Rows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  struct Found {
    Rows boxes;   ///< [boxes, 4] left, top, right, bottom as shares of the picture's sides
    Rows scores;  ///< [boxes, names] in [0, 1]
  };

  /// Throws Error when the model is not of kind detector, a file's digest is not what model.yaml
  /// says, or names, numbers and tensors do not fit each other.
  ThingDetector(const ModelFolder& model, const RuntimeConfig& runtime);

  const std::string& name() const { return name_; }
  /// Each in words for it, separated by |.
  const std::vector<std::string>& things() const { return things_; }

  /// Throws Error when the network fails.
  Found find(const RgbImage& picture) const;
  /// [names] of an object in that box: the best score of a box that overlaps with it by half or
  /// more (intersection over union).
  Eigen::VectorXf log_ratios(const Found& found, const Eigen::AlignedBox2f& box) const;

 private:
  void read_names(const ModelFolder& model);

  std::string name_;
  ImageInputSpec input_spec_;
  OnnxSession network_;
  std::string input_, boxes_, scores_;
  std::vector<std::string> things_;
  std::vector<float> background_;  ///< [names] mean score of objects that are something else
  ScoreRatio ratio_;
};

}  // namespace ovimap
