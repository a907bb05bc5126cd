// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/things/thing_detector.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "ovimap/base/error.h"
#include "ovimap/geometry/box_overlap.h"
#include "ovimap/inference/models/image_tensor.h"

namespace ovimap {

namespace {

constexpr float kLeastOverlap = 0.5f;  // of a box that is taken for the object's
constexpr Eigen::Index kCorners = 4;

const ModelFolder& checked_detector(const ModelFolder& model) {
  checked_model(model, "detector", "to recognize things");
  if (model.input.size_px == 0)
    throw Error(concat("model ", model.folder.string(), ": model.yaml has no 'input'"));
  return model;
}

float number_in(const std::string& text, const ModelFolder& model, const std::string& what,
                float least, float most) {
  char* end = nullptr;
  const float value = std::strtof(text.c_str(), &end);
  if (text.empty() || *end != 0 || !(value >= least && value <= most))
    throw Error(concat("model file ", (model.folder / "model.yaml").string(), ": ", what, " is '",
                       text, "'; a number from ", least, " to ", most, " is accepted"));
  return value;
}

Eigen::AlignedBox2f box_of(const ThingDetector::Rows& boxes, Eigen::Index row) {
  const auto inside = [](float share) { return std::clamp(share, 0.f, 1.f); };
  return {Eigen::Vector2f(inside(boxes(row, 0)), inside(boxes(row, 1))),
          Eigen::Vector2f(inside(boxes(row, 2)), inside(boxes(row, 3)))};
}

ThingDetector::Rows rows_of(const FloatTensor& tensor, Eigen::Index columns) {
  return Eigen::Map<const ThingDetector::Rows>(
      tensor.values.data(), static_cast<Eigen::Index>(tensor.values.size()) / columns, columns);
}

}  // namespace

float ScoreRatio::log_ratio(float score, float background) const {
  return offset + slope * std::log((score + floor) / (background + floor));
}

ThingDetector::ThingDetector(const ModelFolder& model, const RuntimeConfig& runtime)
    : name_(checked_detector(model).name),
      input_spec_(model.input),
      network_(model, "detector", runtime),
      input_(model.input_of("detector", "image")),
      boxes_(model.output_of("detector", "boxes")),
      scores_(model.output_of("detector", "scores")) {
  read_names(model);
  ratio_.floor = number_in(model.extra("floor"), model, "'floor'", 1e-6f, 1.f);
  ratio_.slope = number_in(model.extra("slope"), model, "'slope'", 0.f, 100.f);
  ratio_.offset = number_in(model.extra("offset"), model, "'offset'", -100.f, 100.f);
  network_.input(input_);
  const TensorShape &boxes = network_.output(boxes_).shape,
                    &scores = network_.output(scores_).shape;
  if (boxes.size() != 2 || scores.size() != 2 || boxes[1] != kCorners || boxes[0] != scores[0] ||
      scores[1] != static_cast<std::int64_t>(things_.size()))
    throw Error(concat("model ", model.folder.string(), " answers boxes ", to_text(boxes),
                       " and scores ", to_text(scores), " and names ", things_.size(),
                       " things; expected are [boxes,4] and [boxes,things]"));
}

void ThingDetector::read_names(const ModelFolder& model) {
  std::istringstream lines(model.extra("names"));
  for (std::string line; std::getline(lines, line);) {
    const std::size_t end = line.find(';');
    if (end == 0 || end == std::string::npos)
      throw Error(concat("model file ", (model.folder / "model.yaml").string(), ": '", line,
                         "' is no line of words;background under 'names'"));
    things_.push_back(line.substr(0, end));
    background_.push_back(
        number_in(line.substr(end + 1), model, "the background of " + things_.back(), 0.f, 1.f));
  }
}

ThingDetector::Found ThingDetector::find(const RgbImage& picture) const {
  const FloatTensor image = image_tensor(picture, input_spec_);
  const TensorInput given{input_, image.shape, std::span<const float>(image.values)};
  const std::string wanted[] = {boxes_, scores_};
  const std::vector<FloatTensor> answer = network_.run({&given, 1}, wanted);
  Found found{rows_of(answer[0], kCorners),
              rows_of(answer[1], static_cast<Eigen::Index>(things_.size()))};
  if (input_spec_.resize == ResizeRule::kLongSide) {  // the picture fills a part of the input
    const InputFrame frame = input_frame(picture.width(), picture.height(), input_spec_);
    const auto size = static_cast<float>(input_spec_.size_px);
    const Eigen::Array2f scale(size / static_cast<float>(frame.width_px),
                               size / static_cast<float>(frame.height_px));
    found.boxes *= Eigen::Array4f(scale.x(), scale.y(), scale.x(), scale.y()).matrix().asDiagonal();
  }
  return found;
}

Eigen::VectorXf ThingDetector::log_ratios(const Found& found,
                                          const Eigen::AlignedBox2f& box) const {
  Eigen::VectorXf best = Eigen::VectorXf::Zero(found.scores.cols());
  for (Eigen::Index row = 0; row < found.boxes.rows(); ++row)
    if (overlap(box_of(found.boxes, row), box) >= kLeastOverlap)
      best = best.cwiseMax(found.scores.row(row).transpose());
  for (Eigen::Index thing = 0; thing < best.size(); ++thing)
    best[thing] = ratio_.log_ratio(best[thing], background_[static_cast<std::size_t>(thing)]);
  return best;
}

}  // namespace ovimap
