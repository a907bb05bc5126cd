// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// Exhaustive search by size: where the time leaves what a person notices, an index library pays.
#include <random>

#include <benchmark/benchmark.h>

#include "ovimap/semantics/search_index.h"

namespace ovimap::bench {
namespace {

constexpr std::size_t kTop = 10;

SearchIndex random_index(std::int64_t count, std::int64_t dimension) {
  std::minstd_rand engine(1);
  std::uniform_real_distribution<float> uniform(-1.f, 1.f);
  std::vector<SearchObject> objects(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < objects.size(); ++i) objects[i].id = static_cast<InstanceId>(i + 1);
  return SearchIndex(std::move(objects),
                     Embeddings::NullaryExpr(count, dimension, [&] { return uniform(engine); }));
}

/// Arguments: objects, dimension of an embedding.
void search_objects(benchmark::State& state) {
  const SearchIndex index = random_index(state.range(0), state.range(1));
  const Eigen::VectorXf query = index.embeddings().row(0).transpose();
  for (auto _ : state) benchmark::DoNotOptimize(index.best(index.cosines(query), kTop));
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(search_objects)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->ArgsProduct({{1000, 10000, 100000}, {384, 768}})
    ->Args({1000000, 384});

}  // namespace
}  // namespace ovimap::bench
