// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// What telling objects from one another costs as a walk goes on.
#include <map>
#include <random>

#include <benchmark/benchmark.h>

#include "ovimap/instance/consensus/entity_consensus.h"

namespace ovimap::bench {
namespace {

constexpr Label kInSight = 30, kParts = 20, kSlivers = 30;
constexpr int kFramesAnObject = 10;  ///< until the next comes into sight, and the first leaves it

/// What a walk past a row of objects shows: of each object in sight most parts, some of them in a
/// neighbour's mask, and slivers that no other frame sees.
std::map<Label, std::uint16_t> frame_of_walk(int frame, std::mt19937& random) {
  std::map<Label, std::uint16_t> shown;
  const auto first = static_cast<Label>(frame / kFramesAnObject);
  const auto entity = [&](Label object) {
    const Label seen_in = random() % 10 == 0 ? object + 1 : object;
    return static_cast<std::uint16_t>(seen_in - first + 1);
  };
  for (Label object = first; object < first + kInSight; ++object)
    for (Label part = 0; part < kParts; ++part)
      if (random() % 3 != 0) shown[1 + object * kParts + part] = entity(object);
  for (Label sliver = 0; sliver < kSlivers; ++sliver)
    shown[1'000'000 + static_cast<Label>(frame) * kSlivers + sliver] =
        entity(first + random() % kInSight);
  return shown;
}

EntityConsensus after_walk(int frames) {
  std::mt19937 random(1);
  EntityConsensus consensus;
  for (int frame = 0; frame < frames; ++frame) {
    consensus.observe(frame_of_walk(frame, random));
    consensus.update();
  }
  return consensus;
}

void update_consensus(benchmark::State& state) {
  const int frames = static_cast<int>(state.range(0));
  const EntityConsensus walked = after_walk(frames);
  for (auto _ : state) {
    state.PauseTiming();
    std::mt19937 random(2);
    EntityConsensus consensus = walked;
    state.ResumeTiming();
    consensus.observe(frame_of_walk(frames, random));
    benchmark::DoNotOptimize(consensus.update());
  }
}
BENCHMARK(update_consensus)->Arg(250)->Arg(500)->Arg(1000)->Unit(benchmark::kMillisecond);

void settle_consensus(benchmark::State& state) {
  EntityConsensus consensus = after_walk(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(consensus.settle());
}
BENCHMARK(settle_consensus)->Arg(250)->Arg(500)->Arg(1000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace ovimap::bench
