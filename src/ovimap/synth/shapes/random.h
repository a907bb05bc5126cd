// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace ovimap {

/// Mixes 64 bits so that any change of input changes about half of the output (the finaliser of
/// SplitMix64: Steele, Lea, Flood, "Fast splittable pseudorandom number generators", 2014).
inline std::uint64_t mix_bits(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

/// A generator whose numbers are the same on every machine and compiler, unlike the standard
/// library's distributions.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  /// An independent generator for sub-task `stream` of `seed`.
  Random(std::uint64_t seed, std::uint64_t stream)
      : state_(mix_bits(seed ^ mix_bits(stream + kStep))) {}

  std::uint64_t bits() { return mix_bits(state_ += kStep); }

  /// In [0, 1), 24 bits of resolution: exact in float.
  float uniform() { return static_cast<float>(bits() >> 40) * 0x1p-24f; }
  float uniform(float low, float high) { return low + (high - low) * uniform(); }

  /// In [0, count); count > 0.
  std::size_t index(std::size_t count) { return static_cast<std::size_t>(bits() % count); }

  /// Standard normal (polar method).
  float normal();

  template <class T>
  void shuffle(std::vector<T>& items) {
    for (std::size_t left = items.size(); left > 1; --left)
      std::swap(items[left - 1], items[index(left)]);
  }

 private:
  static constexpr std::uint64_t kStep = 0x9e3779b97f4a7c15ull;
  std::uint64_t state_;
};

}  // namespace ovimap
