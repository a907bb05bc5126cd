// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "ovimap/image/image.h"
#include "ovimap/inference/models/model_folder.h"
#include "ovimap/inference/models/onnx_session.h"
#include "ovimap/inference/writing/text_areas.h"

namespace ovimap {

/// A line of writing that was read in an image.
struct WrittenLine {
  std::string text;            ///< UTF-8, not empty
  float confidence = 0;        ///< mean over the characters, in [0, 1]
  Eigen::AlignedBox2i box_px;  ///< around it in the image, both corners included
};

/// Reads what is written in a picture: a network finds lines (probabilities by pixel), another one
/// spells each (connectionist temporal classification, Graves et al. 2006), as PP-OCR has them.
class WritingReader {
 public:
  /// Throws Error when the model is not of kind writing, a file's digest is not what model.yaml
  /// says, or the speller's file does not tell its characters.
  WritingReader(const ModelFolder& model, const RuntimeConfig& runtime);

  const std::string& name() const { return name_; }

  /// Lines read with at least the model's confidence, from the top down. Throws Error when a
  /// network fails.
  std::vector<WrittenLine> read(const RgbImage& image) const;

 private:
  Image<float> text_probability(const RgbImage& image) const;
  WrittenLine spell(const RgbImage& line) const;
  WrittenLine spell_either_way(const RgbImage& image, const TextArea& area) const;

  std::filesystem::path folder_;
  std::string name_;
  OnnxSession detector_, speller_;
  std::string detector_input_, detector_output_, speller_input_, speller_output_;
  std::vector<std::string> characters_;  ///< [class]; class 0 is none
  TextAreaRule rule_;
  int longest_side_px_ = 0;  ///< of what the detector sees
  float largest_scale_ = 1;  ///< small pictures are enlarged by no more
  int line_height_px_ = 0;   ///< of what the speller sees
  float least_confidence_ = 0;
};

inline constexpr const char* kDefaultReader = "pp-ocr";

/// The model called `spec`, or in that folder. Throws Error as find_model and WritingReader do.
std::unique_ptr<WritingReader> make_writing_reader(
    const std::string& spec, const RuntimeConfig& runtime,
    const std::vector<std::filesystem::path>& model_dirs = {});

}  // namespace ovimap
