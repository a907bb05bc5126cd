// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/track/places/place_code.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "ovimap/geometry/pose.h"

namespace ovimap {

namespace {

constexpr int kMostShift_px = 2;
constexpr int kTurnReach_px = 6;  // of some 20: a third of the field of view

/// Means of the valid pixels of a coarse image's cells; cells without any take the mean of all.
std::array<float, kCodePixels> shrink(const Image<float>& image, float invalid_below) {
  std::array<float, kCodePixels> sums{}, counts{};
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) {
      const float value = image.row(y)[x];
      if (value <= invalid_below) continue;
      const int cell =
          y * kCodeHeight / image.height() * kCodeWidth + x * kCodeWidth / image.width();
      sums[static_cast<std::size_t>(cell)] += value, counts[static_cast<std::size_t>(cell)] += 1;
    }
  const float total = std::reduce(sums.begin(), sums.end()),
              all = std::reduce(counts.begin(), counts.end());
  const float mean = all > 0 ? total / all : 0;
  for (std::size_t i = 0; i < kCodePixels; ++i)
    sums[i] = counts[i] > 0 ? sums[i] / counts[i] - mean : 0.f;
  return sums;
}

void normalise(std::array<float, kCodePixels>& values) {
  const float mean = std::reduce(values.begin(), values.end()) / static_cast<float>(kCodePixels);
  float squares = 0;
  for (float& value : values) value -= mean, squares += value * value;
  const float length = std::sqrt(squares);
  for (float& value : values) value = length > 0 ? value / length : 0;
}

double product(const std::array<float, kCodePixels>& a, const std::array<float, kCodePixels>& b,
               int dx, int dy) {
  float sum = 0;
  for (int y = std::max(0, -dy); y < std::min(kCodeHeight, kCodeHeight - dy); ++y)
    for (int x = std::max(0, -dx); x < std::min(kCodeWidth, kCodeWidth - dx); ++x)
      sum += a[static_cast<std::size_t>(y * kCodeWidth + x)] *
             b[static_cast<std::size_t>((y + dy) * kCodeWidth + x + dx)];
  return sum;
}

/// Mean square of what intensities differ by, their means aside, where a shifted image overlaps.
double difference(const Image<float>& a, const Image<float>& b, int dx, int dy) {
  double sum = 0, squares = 0, count = 0;
  for (int y = std::max(0, -dy); y < std::min(a.height(), a.height() - dy); ++y)
    for (int x = std::max(0, -dx); x < std::min(a.width(), a.width() - dx); ++x) {
      const float here = a.row(y)[x], there = b.row(y + dy)[x + dx];
      if (here < 0 || there < 0) continue;
      const double step = there - here;
      sum += step, squares += step * step, count += 1;
    }
  if (count < static_cast<double>(a.size()) / 4) return 1e12;
  return squares / count - (sum / count) * (sum / count);
}

Image<float> halved_intensity(const Image<float>& fine) {
  Image<float> coarse(fine.width() / 2, fine.height() / 2, -1.f);
  for (int y = 0; y < coarse.height(); ++y)
    for (int x = 0; x < coarse.width(); ++x) {
      const float *upper = fine.row(2 * y) + 2 * x, *lower = fine.row(2 * y + 1) + 2 * x;
      if (std::min({upper[0], upper[1], lower[0], lower[1]}) >= 0)
        coarse.row(y)[x] = (upper[0] + upper[1] + lower[0] + lower[1]) / 4;
    }
  return coarse;
}

/// The shift around a first guess at which two images differ least.
Eigen::Vector2i best_shift(const Image<float>& a, const Image<float>& b,
                           const Eigen::Vector2i& guess, int reach_px) {
  Eigen::Vector2i best = guess;
  double least = 1e13;
  for (int dy = guess.y() - reach_px; dy <= guess.y() + reach_px; ++dy)
    for (int dx = guess.x() - reach_px; dx <= guess.x() + reach_px; ++dx)
      if (const double off = difference(a, b, dx, dy); off < least) least = off, best = {dx, dy};
  return best;
}

}  // namespace

PlaceCode place_code(const TrackPyramid& pyramid) {
  const TrackLevel& coarse = pyramid.back();
  PlaceCode code{shrink(coarse.intensity, -0.5f), shrink(coarse.inverse_depth, 0.f)};
  normalise(code.intensity);
  normalise(code.inverse_depth);
  return code;
}

double similarity(const PlaceCode& a, const PlaceCode& b) {
  double best = -2, depth = 0;
  for (int dy = -kMostShift_px; dy <= kMostShift_px; ++dy)
    for (int dx = -kMostShift_px; dx <= kMostShift_px; ++dx)
      if (const double alike = product(a.intensity, b.intensity, dx, dy); alike > best) {
        best = alike;
        depth = product(a.inverse_depth, b.inverse_depth, dx, dy);
      }
  return (best + depth) / 2;
}

std::vector<std::size_t> most_similar(const PlaceCode& code, const std::vector<PlaceCode>& codes,
                                      std::size_t count, double min_similarity) {
  std::vector<std::pair<double, std::size_t>> ranked;
  for (std::size_t i = 0; i < codes.size(); ++i)
    if (const double alike = similarity(code, codes[i]); alike >= min_similarity)
      ranked.emplace_back(-alike, i);
  std::sort(ranked.begin(), ranked.end());
  std::vector<std::size_t> best;
  for (std::size_t i = 0; i < std::min(count, ranked.size()); ++i) best.push_back(ranked[i].second);
  return best;
}

Pose turn_between(const TrackPyramid& reference, const TrackPyramid& frame) {
  const TrackLevel &a = reference.back(), &b = frame.back();
  if (!a.intensity.same_size(b.intensity))
    return Pose::Identity();  // of two cameras: nothing is known of the turn
  const Image<float> small_a = halved_intensity(a.intensity),
                     small_b = halved_intensity(b.intensity);
  const Eigen::Vector2i rough =
      best_shift(small_a, small_b, Eigen::Vector2i::Zero(), kTurnReach_px);
  const Eigen::Vector2f shift = best_shift(a.intensity, b.intensity, 2 * rough, 1).cast<float>();
  // What the reference has in its middle, the frame has shifted.
  const Eigen::Vector3d seen =
      b.camera.unproject(b.camera.cx + shift.x(), b.camera.cy + shift.y(), 1.f).cast<double>();
  Pose turn = Pose::Identity();
  turn.linear() = shortest_turn(seen, Eigen::Vector3d::UnitZ()).matrix();
  return turn;
}

}  // namespace ovimap
