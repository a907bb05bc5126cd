// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/words/thing_sizes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "ovimap/base/error.h"
#include "ovimap/semantics/words/word_lists.h"

namespace ovimap {

namespace {

// Deviations were chosen on generated rooms that are no test (docs/experiments.md).
constexpr float kSmallerDeviation = 0.6f, kLargerDeviation = 0.45f;  // of logarithms
constexpr float kDepthWeight = 0.5f;  // the side away from the camera is seen least
constexpr float kBottomDeviation_m = 0.25f;
constexpr float kMostPenalty = 2.5f;      // of one size in log likelihood: maps merge and cut
constexpr float kMostPlacePenalty = 3.f;  // ... and anything can be put anywhere
constexpr float kTopDeviation_m = 0.05f, kTopDeviation = 0.15f;  // of maps, and of things' heights
constexpr float kShareDeviation = 0.12f;                         // of the surface
// Deviations of logarithms around what maps showed: half as much again as things of a name differ.
constexpr float kSeenHeight = 0.35f, kSeenLength = 0.45f, kSeenDepth = 0.5f, kSeenTop = 0.3f;
constexpr int kSizes = 5, kSpreads = 2;  // of a thing's standard measures
constexpr float kLowestTop_m = 0.1f;     // below it heights of tops are noise
constexpr float kThinnest_m = 0.02f;     // below it a size is noise

float log_term(float object_m, float usual_m) {
  const float ratio = std::log(std::max(object_m, kThinnest_m) / std::max(usual_m, kThinnest_m));
  const float deviations = ratio / (ratio < 0.f ? kSmallerDeviation : kLargerDeviation);
  return -std::min(0.5f * deviations * deviations, kMostPenalty);
}

/// How far a height is from a range, in deviations.
float deviations_from(float height_m, float from_m, float to_m, float deviation_m) {
  return std::max({0.f, from_m - height_m, height_m - to_m}) / deviation_m;
}

/// Of the bottom and of the top, half of each.
float place_term(const ObjectMeasures& object, const ThingSize& thing) {
  const ObjectMeasures& usual = thing.usual;
  const float bottom =
      deviations_from(object.bottom_m, usual.bottom_m, thing.highest_bottom_m, kBottomDeviation_m);
  const float top =
      deviations_from(object.top_m(), usual.top_m(), thing.highest_bottom_m + usual.height_m,
                      std::hypot(kTopDeviation_m, kTopDeviation * usual.height_m));
  // A thing that may be anywhere says less about where it is.
  const float spread = std::log(thing.highest_bottom_m - usual.bottom_m + kBottomDeviation_m);
  return -std::min(0.25f * (bottom * bottom + top * top), kMostPlacePenalty) - spread;
}

float usual_term(const ObjectMeasures& object, const ThingSize& thing) {
  const ObjectMeasures& usual = thing.usual;
  return log_term(object.height_m, usual.height_m) + log_term(object.length_m, usual.length_m) +
         kDepthWeight * log_term(object.depth_m, usual.depth_m) + place_term(object, thing);
}

/// Whether it says what is usual, and not alone what maps showed.
bool is_usual(const ThingSize& thing) {
  return thing.usual.length_m > 0.f;
}

/// Of logarithms of likelihoods, each measure by itself.
template <int kCount>
float bounded_sum(const Eigen::Array<float, kCount, 1>& deviations) {
  return -(0.5f * deviations.square()).min(kMostPenalty).sum();
}

Error no_size(const std::string& line) {
  return Error(concat("'", line, "' is no size"));
}

/// A line "word;number;number", with as many numbers as `names`, parted by ';', has names.
std::pair<std::string, std::vector<float>> read_numbers(const std::string& line,
                                                        const std::string& names) {
  std::istringstream in(line);
  std::string word;
  std::getline(in, word, ';');
  std::vector<float> numbers(1 +
                             static_cast<std::size_t>(std::count(names.begin(), names.end(), ';')));
  char separator = ';';
  for (float& number : numbers) {
    if (&number != &numbers.front()) in >> separator;
    in >> number;
  }
  if (!in) throw Error(concat("'", line, "' is no size; give word;", names));
  return {word, numbers};
}

}  // namespace

StandardMeasures standard_measures(const ObjectMeasures& measures) {
  const auto logarithm = [](float size_m, float least_m) {
    return std::log(std::max(size_m, least_m));
  };
  StandardMeasures standard;
  standard << logarithm(measures.height_m, kThinnest_m) / kSeenHeight,
      logarithm(measures.length_m, kThinnest_m) / kSeenLength,
      logarithm(measures.depth_m, kThinnest_m) / kSeenDepth, measures.bottom_m / kBottomDeviation_m,
      logarithm(measures.top_m(), kLowestTop_m) / kSeenTop, measures.top_share / kShareDeviation,
      measures.covered_share / kShareDeviation;
  return standard;
}

std::vector<ThingSize> read_thing_sizes(const std::vector<std::string>& usual,
                                        const std::vector<std::string>& seen) {
  std::vector<ThingSize> things;
  std::map<std::string, std::size_t> places;
  const auto thing_of = [&](const std::string& word) -> ThingSize& {
    const auto [place, is_new] = places.try_emplace(word, things.size());
    if (is_new) things.push_back({word, {}, 0.f, {}});
    return things[place->second];
  };
  for (const std::string& line : usual) {
    const auto [word, numbers] = read_numbers(line, "height;length;depth;bottom from;bottom to");
    if (numbers[0] < 0.f || numbers[4] < numbers[3]) throw no_size(line);
    ThingSize& thing = thing_of(word);
    thing.usual = {numbers[0], numbers[1], numbers[2], numbers[3]};
    thing.highest_bottom_m = numbers[4];
  }
  for (const std::string& line : seen) {
    const auto [word, numbers] =
        read_numbers(line, "height;length;depth;bottom;top share;covered share;count");
    if (!(numbers[6] > 0.f)) throw no_size(line);
    thing_of(word).seen.push_back({standard_measures({numbers[0], numbers[1], numbers[2],
                                                      numbers[3], numbers[4], numbers[5]}),
                                   numbers[6]});
  }
  for (ThingSize& thing : things) {
    float count = 0.f;
    for (const SeenSize& way : thing.seen) count += way.share;
    for (SeenSize& way : thing.seen) way.share /= count;
  }
  return things;
}

const std::vector<ThingSize>& builtin_thing_sizes() {
  static const auto things = read_thing_sizes(list_entries(builtin_word_list("thing_sizes")),
                                              list_entries(builtin_word_list("seen_sizes")));
  return things;
}

std::vector<float> size_likelihoods(const ObjectMeasures& object,
                                    std::span<const ThingSize> things) {
  std::vector<float> likelihoods(things.size(), 0.f);
  const StandardMeasures at = standard_measures(object);
  const bool spread_known = object.top_share >= 0.f;
  float spread = 0.f, seen_things = 0.f;
  for (std::size_t i = 0; i < things.size(); ++i) {
    for (const SeenSize& way : things[i].seen) {
      const StandardMeasures away = at - way.measures;
      const float of_size = bounded_sum<kSizes>(away.head<kSizes>());
      const float of_spread = spread_known ? bounded_sum<kSpreads>(away.tail<kSpreads>()) : 0.f;
      likelihoods[i] += way.share * std::exp(of_size + of_spread);
      spread += way.share * std::exp(of_spread);
    }
    if (!things[i].seen.empty()) seen_things += 1.f;
  }
  if (seen_things > 0.f) spread /= seen_things;
  for (std::size_t i = 0; i < things.size(); ++i) {
    const ThingSize& thing = things[i];
    if (!is_usual(thing)) continue;
    const float fit = (seen_things > 0.f ? spread : 1.f) * std::exp(usual_term(object, thing));
    likelihoods[i] += (fit - likelihoods[i]) / static_cast<float>(1 + thing.seen.size());
  }
  return likelihoods;
}

}  // namespace ovimap
