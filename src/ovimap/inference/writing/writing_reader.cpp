// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/writing/writing_reader.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <sstream>

#include "ovimap/base/error.h"
#include "ovimap/image/resize.h"

namespace ovimap {

namespace {

constexpr int kDetectorStep = 32;     // sides of its input are multiples of it
constexpr float kLongestLine = 40.f;  // lengths by heights; longer areas are no line
constexpr int kShortestLinePx = 16;   // of what the speller sees
constexpr float kSureEnough = 0.9f;   // a line read so well is not read upside down as well
constexpr const char* kCharacters = "character";  // key of the speller's own list

float number_of(const ModelFolder& model, const char* key, float least, float most) {
  const std::string text = model.extra(key);
  char* end = nullptr;
  const float value = std::strtof(text.c_str(), &end);
  if (text.empty() || *end != 0 || !(value >= least && value <= most))
    throw Error(concat("model file ", (model.folder / "model.yaml").string(), ": '", key, "' is '",
                       text, "'; a number from ", least, " to ", most, " is accepted"));
  return value;
}

/// Nothing, the characters of the list one a line, and the blank.
std::vector<std::string> characters_of(const OnnxSession& speller, const std::string& output,
                                       const std::filesystem::path& folder) {
  std::vector<std::string> characters{""};
  std::istringstream list(speller.metadata(kCharacters));
  for (std::string character; std::getline(list, character);) characters.push_back(character);
  characters.emplace_back(" ");
  const TensorShape& shape = speller.output(output).shape;
  if (characters.size() == 2 || shape.size() != 3 ||
      shape[2] != static_cast<std::int64_t>(characters.size()))
    throw Error(concat("model ", folder.string(), ": the speller tells ", characters.size() - 2,
                       " characters ('", kCharacters, "' of its metadata) and answers ",
                       to_text(shape), "; expected is two more, for none and for a blank"));
  return characters;
}

/// Values (pixel / 255 - 0.5) / 0.5, planes blue, green, red: the order that PP-OCR was trained in.
std::vector<float> planes_of(const RgbImage& image) {
  const std::size_t count = image.size();
  std::vector<float> values(3 * count);
  const auto scaled = [](std::uint8_t value) { return static_cast<float>(value) / 127.5f - 1.f; };
  for (std::size_t i = 0; i < count; ++i) {
    values[i] = scaled(image[i].b);
    values[count + i] = scaled(image[i].g);
    values[2 * count + i] = scaled(image[i].r);
  }
  return values;
}

FloatTensor run_on(const OnnxSession& network, const std::string& input, const std::string& output,
                   const RgbImage& image) {
  const std::vector<float> values = planes_of(image);
  const TensorInput given{
      input, {1, 3, image.height(), image.width()}, std::span<const float>(values)};
  return network.run({&given, 1}, {&output, 1})[0];
}

Rgb8 sample(const RgbImage& image, const Eigen::Vector2f& at) {
  const float x = std::clamp(at.x(), 0.f, static_cast<float>(image.width() - 1));
  const float y = std::clamp(at.y(), 0.f, static_cast<float>(image.height() - 1));
  const int left = static_cast<int>(x), top = static_cast<int>(y);
  const int right = std::min(left + 1, image.width() - 1);
  const int bottom = std::min(top + 1, image.height() - 1);
  const float u = x - static_cast<float>(left), v = y - static_cast<float>(top);
  const auto mix = [&](auto channel) {
    const auto value = [&](int cx, int cy) {
      return static_cast<float>(image.at(cx, cy).*channel);
    };
    return static_cast<std::uint8_t>(
        (1 - v) * ((1 - u) * value(left, top) + u * value(right, top)) +
        v * ((1 - u) * value(left, bottom) + u * value(right, bottom)) + 0.5f);
  };
  return {mix(&Rgb8::r), mix(&Rgb8::g), mix(&Rgb8::b)};
}

/// The area upright, so high.
RgbImage straightened(const RgbImage& image, const TextArea& area, int height_px) {
  const float scale = area.height_px / static_cast<float>(height_px);
  const int width = std::max(kShortestLinePx, static_cast<int>(std::ceil(area.length_px / scale)));
  const Eigen::Vector2f across(-area.along.y(), area.along.x());
  RgbImage line(width, height_px);
  for (int y = 0; y < height_px; ++y)
    for (int x = 0; x < width; ++x) {
      const float u = (static_cast<float>(x) + 0.5f) * scale - 0.5f * area.length_px;
      const float v = (static_cast<float>(y) + 0.5f) * scale - 0.5f * area.height_px;
      line.at(x, y) = sample(image, area.center_px + u * area.along + v * across);
    }
  return line;
}

Eigen::AlignedBox2i box_of(const TextArea& area, const RgbImage& image) {
  const Eigen::Vector2f along = 0.5f * area.length_px * area.along;
  const Eigen::Vector2f across =
      0.5f * area.height_px * Eigen::Vector2f(-area.along.y(), area.along.x());
  const Eigen::Array2f reach = along.array().abs() + across.array().abs();
  const Eigen::Array2i last(image.width() - 1, image.height() - 1);
  const auto inside = [&](const Eigen::Array2f& at) {
    return at.round().cast<int>().max(0).min(last).matrix().eval();
  };
  return {inside(area.center_px.array() - reach), inside(area.center_px.array() + reach)};
}

}  // namespace

WritingReader::WritingReader(const ModelFolder& model, const RuntimeConfig& runtime)
    : folder_(checked_model(model, "writing", "to read writing").folder),
      name_(model.name),
      detector_(model, "detector", runtime),
      speller_(model, "speller", runtime),
      detector_input_(model.input_of("detector", "image")),
      detector_output_(model.output_of("detector", "probability")),
      speller_input_(model.input_of("speller", "line")),
      speller_output_(model.output_of("speller", "characters")) {
  detector_.input(detector_input_);
  detector_.output(detector_output_);
  speller_.input(speller_input_);
  characters_ = characters_of(speller_, speller_output_, folder_);
  rule_.pixel_level = number_of(model, "pixel_level", 0.f, 1.f);
  rule_.area_level = number_of(model, "area_level", 0.f, 1.f);
  rule_.growth = number_of(model, "growth", 0.f, 10.f);
  longest_side_px_ = static_cast<int>(number_of(model, "longest_side_px", 32.f, 4096.f));
  largest_scale_ = number_of(model, "largest_scale", 1.f, 16.f);
  line_height_px_ = static_cast<int>(number_of(model, "line_height_px", 8.f, 256.f));
  least_confidence_ = number_of(model, "least_confidence", 0.f, 1.f);
}

std::vector<WrittenLine> WritingReader::read(const RgbImage& image) const {
  std::vector<WrittenLine> lines;
  if (image.empty()) return lines;
  const Image<float> probability = text_probability(image);
  const Eigen::Array2f scale(
      static_cast<float>(image.width()) / static_cast<float>(probability.width()),
      static_cast<float>(image.height()) / static_cast<float>(probability.height()));
  for (TextArea area : find_text_areas(probability, rule_)) {
    area.center_px = ((area.center_px.array() + 0.5f) * scale - 0.5f).matrix();
    // Both scales are alike but for the rounding of the sides.
    area.length_px *= scale.mean();
    area.height_px *= scale.mean();
    if (area.length_px > kLongestLine * area.height_px) continue;
    WrittenLine line = spell_either_way(image, area);
    if (!line.text.empty() && line.confidence >= least_confidence_)
      lines.push_back(std::move(line));
  }
  return lines;
}

Image<float> WritingReader::text_probability(const RgbImage& image) const {
  const float longest = static_cast<float>(std::max(image.width(), image.height()));
  const float scale = std::min(static_cast<float>(longest_side_px_) / longest, largest_scale_);
  const auto side = [&](int px) {
    const float steps = scale * static_cast<float>(px) / static_cast<float>(kDetectorStep);
    return kDetectorStep * std::max(1, static_cast<int>(std::lround(steps)));
  };
  const RgbImage input = resize_bilinear(image, side(image.width()), side(image.height()));
  const FloatTensor output = run_on(detector_, detector_input_, detector_output_, input);
  if (output.shape != TensorShape{1, 1, input.height(), input.width()})
    throw Error(concat("model ", folder_.string(), ": the detector answers ", to_text(output.shape),
                       " to an image of ", input.width(), "x", input.height(),
                       "; expected is a probability for each pixel"));
  Image<float> probability(input.width(), input.height());
  std::copy(output.values.begin(), output.values.end(), probability.begin());
  return probability;
}

WrittenLine WritingReader::spell_either_way(const RgbImage& image, const TextArea& area) const {
  WrittenLine line = spell(straightened(image, area, line_height_px_));
  if (line.confidence < kSureEnough) {
    TextArea turned = area;  // what lies on a table is seen from any side
    turned.along = -area.along;
    WrittenLine other = spell(straightened(image, turned, line_height_px_));
    if (other.confidence > line.confidence) line = std::move(other);
  }
  line.box_px = box_of(area, image);
  return line;
}

/// The likeliest class of each step; one that lasts is one character.
WrittenLine WritingReader::spell(const RgbImage& image) const {
  const FloatTensor output = run_on(speller_, speller_input_, speller_output_, image);
  const std::size_t classes = characters_.size();
  WrittenLine line;
  double sum = 0;
  int characters = 0;
  std::ptrdiff_t before = 0;
  for (std::size_t at = 0; at + classes <= output.values.size(); at += classes) {
    const auto step = output.values.begin() + static_cast<std::ptrdiff_t>(at);
    const auto best = std::max_element(step, step + static_cast<std::ptrdiff_t>(classes));
    const std::ptrdiff_t character = best - step;
    if (character != 0 && character != before) {
      line.text += characters_[static_cast<std::size_t>(character)];
      sum += double{*best};
      ++characters;
    }
    before = character;
  }
  const std::size_t first = line.text.find_first_not_of(' ');
  if (first == std::string::npos) return {};
  line.text = line.text.substr(first, line.text.find_last_not_of(' ') - first + 1);
  line.confidence = static_cast<float>(std::clamp(sum / characters, 0.0, 1.0));
  return line;
}

std::unique_ptr<WritingReader> make_writing_reader(
    const std::string& spec, const RuntimeConfig& runtime,
    const std::vector<std::filesystem::path>& model_dirs) {
  return std::make_unique<WritingReader>(
      read_model_folder(named_model(spec, model_search_path(model_dirs))), runtime);
}

}  // namespace ovimap
