// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>

namespace ovimap {

/// Eight values worked on at once, in the vector language that GCC and Clang share: arithmetic and
/// comparisons go lane by lane, `mask ? a : b` chooses by lane. One register with AVX, two without;
/// use inside OVIMAP_VECTORIZE functions.
inline constexpr int kLanes = 8;
using Floats = float __attribute__((vector_size(kLanes * sizeof(float))));
using Ints = std::int32_t __attribute__((vector_size(kLanes * sizeof(std::int32_t))));

// Always inlined, so that it does not matter how a processor passes vectors.
#define OVIMAP_LANES_INLINE inline __attribute__((always_inline))

OVIMAP_LANES_INLINE Floats broadcast(float value) {
  return Floats{} + value;
}

OVIMAP_LANES_INLINE Floats load(const float* values) {
  Floats lanes;
  std::memcpy(&lanes, values, sizeof(lanes));
  return lanes;
}

OVIMAP_LANES_INLINE void store(Floats lanes, float* values) {
  std::memcpy(values, &lanes, sizeof(lanes));
}

/// Eight stored 16-bit integers.
template <class Stored>
OVIMAP_LANES_INLINE Floats load_integers(const Stored* values) {
  typedef Stored Packed __attribute__((vector_size(kLanes * sizeof(std::int16_t))));
  static_assert(sizeof(Stored) == sizeof(std::int16_t));
  Packed packed;
  std::memcpy(&packed, values, sizeof(packed));
  return __builtin_convertvector(__builtin_convertvector(packed, Ints), Floats);
}

/// Rounds to nearest, halves away from zero.
template <class Stored>
OVIMAP_LANES_INLINE void store_integers(Floats lanes, Stored* values) {
  typedef Stored Packed __attribute__((vector_size(kLanes * sizeof(std::int16_t))));
  static_assert(sizeof(Stored) == sizeof(std::int16_t));
  const Floats half = lanes < 0.f ? broadcast(-0.5f) : broadcast(0.5f);
  const Packed packed =
      __builtin_convertvector(__builtin_convertvector(lanes + half, Ints), Packed);
  std::memcpy(values, &packed, sizeof(packed));
}

OVIMAP_LANES_INLINE Floats smaller(Floats a, Floats b) {
  return a < b ? a : b;
}
OVIMAP_LANES_INLINE Floats larger(Floats a, Floats b) {
  return a > b ? a : b;
}
OVIMAP_LANES_INLINE Floats magnitude(Floats a) {
  return a < 0.f ? -a : a;
}

OVIMAP_LANES_INLINE bool any(Ints mask) {
  std::uint64_t words[kLanes / 2];
  std::memcpy(words, &mask, sizeof(words));
  return (words[0] | words[1] | words[2] | words[3]) != 0;
}

#undef OVIMAP_LANES_INLINE

}  // namespace ovimap
