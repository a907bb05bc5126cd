// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

namespace ovimap {

/// Eight values worked on at once, in the vector language that GCC and Clang share: arithmetic and
/// comparisons go lane by lane, `mask ? a : b` chooses by lane. One register with AVX, two without;
/// use inside OVIMAP_VECTORIZE functions.
inline constexpr int kLanes = 8;
using Floats = float __attribute__((vector_size(kLanes * sizeof(float))));
using Ints = std::int32_t __attribute__((vector_size(kLanes * sizeof(std::int32_t))));

/// Of functions on lanes: always inlined, so that it does not matter how a processor passes
/// vectors.
#define OVIMAP_INLINE inline __attribute__((always_inline))

OVIMAP_INLINE Floats broadcast(float value) {
  return Floats{} + value;
}

/// Each lane's own number, 0 to 7.
OVIMAP_INLINE Ints lane_numbers() {
  return Ints{0, 1, 2, 3, 4, 5, 6, 7};
}

/// `first`, and one more with each lane.
OVIMAP_INLINE Floats counted_from(float first) {
  return first + __builtin_convertvector(lane_numbers(), Floats);
}

OVIMAP_INLINE Floats load(const float* values) {
  Floats lanes;
  std::memcpy(&lanes, values, sizeof(lanes));
  return lanes;
}

OVIMAP_INLINE void store(Floats lanes, float* values) {
  std::memcpy(values, &lanes, sizeof(lanes));
}

/// Eight stored 16-bit integers.
template <class Stored>
OVIMAP_INLINE Floats load_integers(const Stored* values) {
  typedef Stored Packed __attribute__((vector_size(kLanes * sizeof(std::int16_t))));
  static_assert(sizeof(Stored) == sizeof(std::int16_t));
  Packed packed;
  std::memcpy(&packed, values, sizeof(packed));
  return __builtin_convertvector(__builtin_convertvector(packed, Ints), Floats);
}

/// Rounds to nearest, halves away from zero.
template <class Stored>
OVIMAP_INLINE void store_integers(Floats lanes, Stored* values) {
  typedef Stored Packed __attribute__((vector_size(kLanes * sizeof(std::int16_t))));
  static_assert(sizeof(Stored) == sizeof(std::int16_t));
  const Floats half = lanes < 0.f ? broadcast(-0.5f) : broadcast(0.5f);
  const Packed packed =
      __builtin_convertvector(__builtin_convertvector(lanes + half, Ints), Packed);
  std::memcpy(values, &packed, sizeof(packed));
}

OVIMAP_INLINE Floats smaller(Floats a, Floats b) {
  return a < b ? a : b;
}
OVIMAP_INLINE Floats larger(Floats a, Floats b) {
  return a > b ? a : b;
}
OVIMAP_INLINE Floats magnitude(Floats a) {
  return a < 0.f ? -a : a;
}
OVIMAP_INLINE Floats square_root(Floats a) {
  Floats roots;
  for (int lane = 0; lane < kLanes; ++lane) roots[lane] = std::sqrt(a[lane]);
  return roots;
}

/// `value(lane)` of every lane; lambdas should be always_inline.
template <class Value>
OVIMAP_INLINE Ints ints_by_lane(Value&& value) {
  return Ints{value(0), value(1), value(2), value(3), value(4), value(5), value(6), value(7)};
}

/// `values[indices]`.
OVIMAP_INLINE Floats gather(const float* values, Ints indices) {
  return Floats{values[indices[0]], values[indices[1]], values[indices[2]], values[indices[3]],
                values[indices[4]], values[indices[5]], values[indices[6]], values[indices[7]]};
}

/// The largest integers not above the values.
OVIMAP_INLINE Ints floor_of(Floats values) {
  const Ints truncated = __builtin_convertvector(values, Ints);
  return truncated + (__builtin_convertvector(truncated, Floats) > values);  // a mask is -1
}

OVIMAP_INLINE bool any(Ints mask) {
  std::uint64_t words[kLanes / 2];
  std::memcpy(words, &mask, sizeof(words));
  return (words[0] | words[1] | words[2] | words[3]) != 0;
}

/// The sum of all lanes, always in the same order.
OVIMAP_INLINE float sum_of(Floats lanes) {
  float sum = 0;
  for (int lane = 0; lane < kLanes; ++lane) sum += lanes[lane];
  return sum;
}

/// How many lanes a mask has set.
OVIMAP_INLINE int count_of(Ints mask) {
  int count = 0;
  for (int lane = 0; lane < kLanes; ++lane) count -= mask[lane];
  return count;
}

}  // namespace ovimap
