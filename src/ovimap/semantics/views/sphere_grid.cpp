// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/views/sphere_grid.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>

#include "ovimap/base/error.h"
#include "ovimap/base/vectorize.h"

namespace ovimap {

namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr std::size_t kChunk = 256;  // directions whose bins are computed before any is marked

/// Arctangent of y / x in the right quadrant, without branches: a polynomial for atan on [0, 1]
/// (fitted for the smallest largest error, 4e-8), unfolded to the whole circle.
inline float arc_tangent(float y, float x) {
  const float ax = std::fabs(x), ay = std::fabs(y);
  const float high = ax > ay ? ax : ay, low = ax > ay ? ay : ax;
  const float ratio = high > 0.f ? low / high : 0.f;
  const float s = ratio * ratio;
  float p = -0.004054565f;
  p = p * s + 0.021862950f;
  p = p * s - 0.055912315f;
  p = p * s + 0.096421964f;
  p = p * s - 0.139086292f;
  p = p * s + 0.199465656f;
  p = p * s - 0.333298608f;
  p = p * s + 0.999999336f;
  float angle = p * ratio;
  angle = ay > ax ? 0.5f * kPi - angle : angle;
  angle = x < 0.f ? kPi - angle : angle;
  return y < 0.f ? -angle : angle;
}

/// Bins of up to kChunk directions; -1 for those without one.
OVIMAP_VECTORIZE void bins_of(const SphereGrid& grid, const float* x, const float* y,
                              const float* z, std::int32_t* bins, std::size_t count) {
  const float rows = static_cast<float>(grid.rows) / kPi,
              columns = static_cast<float>(grid.columns) / (2.f * kPi);
  const std::int32_t last_row = grid.rows - 1, last_column = grid.columns - 1;
  for (std::size_t i = 0; i < count; ++i) {
    const float flat = x[i] * x[i] + y[i] * y[i];
    const float length = flat + z[i] * z[i];
    const float theta = arc_tangent(std::sqrt(flat), z[i]);
    const float phi = arc_tangent(y[i], x[i]) + kPi;
    const auto row = static_cast<std::int32_t>(theta * rows);
    const auto column = static_cast<std::int32_t>(phi * columns);
    const std::int32_t bin = (row < last_row ? row : last_row) * grid.columns +
                             (column < last_column ? column : last_column);
    bins[i] = length > 0.f && length < 1e30f ? bin : -1;
  }
}

}  // namespace

int bin_of(const SphereGrid& grid, const Eigen::Vector3f& direction) {
  const float length = direction.norm();
  if (!(length > 0.f) || !std::isfinite(length)) return -1;
  const Eigen::Vector3d unit = direction.cast<double>() / static_cast<double>(length);
  const double theta = std::acos(std::clamp(unit.z(), -1., 1.));
  const double phi = std::atan2(unit.y(), unit.x()) + std::numbers::pi;
  const int row = static_cast<int>(theta / std::numbers::pi * grid.rows);
  const int column = static_cast<int>(phi / (2 * std::numbers::pi) * grid.columns);
  return std::min(row, grid.rows - 1) * grid.columns + std::min(column, grid.columns - 1);
}

std::optional<BinSet> BinSet::from_words(std::vector<std::uint64_t> words, int bins) {
  BinSet set(bins);
  const int rest = bins % 64;
  if (words.size() != set.words_.size() || (rest != 0 && words.back() >> rest != 0))
    return std::nullopt;
  set.words_ = std::move(words);
  return set;
}

int BinSet::count() const {
  int bits = 0;
  for (const std::uint64_t word : words_) bits += std::popcount(word);
  return bits;
}

int BinSet::count_outside(const BinSet& other) const {
  OVIMAP_ASSERT(words_.size() == other.words_.size());
  int bits = 0;
  for (std::size_t i = 0; i < words_.size(); ++i)
    bits += std::popcount(words_[i] & ~other.words_[i]);
  return bits;
}

BinSet& BinSet::operator|=(const BinSet& other) {
  OVIMAP_ASSERT(words_.size() == other.words_.size());
  for (std::size_t i = 0; i < words_.size(); ++i) words_[i] |= other.words_[i];
  return *this;
}

void mark_directions(const SphereGrid& grid, const Directions& directions, BinSet& bins) {
  std::array<std::int32_t, kChunk> chunk;
  for (std::size_t begin = 0; begin < directions.x.size(); begin += kChunk) {
    const std::size_t count = std::min(kChunk, directions.x.size() - begin);
    bins_of(grid, directions.x.data() + begin, directions.y.data() + begin,
            directions.z.data() + begin, chunk.data(), count);
    for (std::size_t i = 0; i < count; ++i)
      if (chunk[i] >= 0) bins.set(chunk[i]);
  }
}

}  // namespace ovimap
