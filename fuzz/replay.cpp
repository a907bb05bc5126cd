// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// Runs a fuzz target on every file of a folder and on variations of them, the same ones every time.
// Usage: PROGRAM FOLDER VARIATIONS
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <random>

#include "ovimap/image/codec.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

using ovimap::Bytes;

void run(const Bytes& bytes) {
  LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
}

/// A few bits flipped, a stretch overwritten, removed or repeated, or the end cut off.
Bytes variation(const Bytes& original, std::mt19937& random) {
  Bytes bytes = original;
  const auto below = [&](std::size_t limit) { return random() % std::max<std::size_t>(limit, 1); };
  for (std::size_t change = 0; change <= below(3) && !bytes.empty(); ++change) {
    const std::size_t at = below(bytes.size()), length = std::min(1 + below(64), bytes.size() - at);
    const auto begin = bytes.begin() + static_cast<std::ptrdiff_t>(at),
               end = begin + static_cast<std::ptrdiff_t>(length);
    switch (below(6)) {
      case 0:
      case 1:
        bytes[at] = static_cast<std::uint8_t>(bytes[at] ^ (1u << below(8)));
        break;
      case 2:
        std::generate(begin, end, [&] { return static_cast<std::uint8_t>(random()); });
        break;
      case 3:
        std::fill(begin, end, static_cast<std::uint8_t>(below(2) == 0 ? 0 : 255));
        break;
      case 4:
        bytes.erase(begin, end);
        break;
      default:
        bytes.resize(at);
    }
  }
  return bytes;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: %s FOLDER VARIATIONS\n", argv[0]);
    return 2;
  }
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(argv[1]))
    files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  if (files.empty()) {
    std::fprintf(stderr, "%s is empty\n", argv[1]);
    return 2;
  }
  std::vector<Bytes> seeds;
  for (const auto& file : files) run(seeds.emplace_back(ovimap::read_file(file)));
  run({});
  std::mt19937 random(1);
  const int variations = std::atoi(argv[2]);
  for (int i = 0; i < variations; ++i) run(variation(seeds[random() % seeds.size()], random));
  std::printf("%zu files, %d variations\n", files.size(), variations);
  return 0;
}
