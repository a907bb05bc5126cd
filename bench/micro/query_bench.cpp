// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// Exhaustive search by size: where the time leaves what a person notices, an index library pays.
#include <random>

#include <benchmark/benchmark.h>

#include "ovimap/semantics/query/query_matcher.h"
#include "ovimap/semantics/query/verdict.h"
#include "ovimap/semantics/words/thing_sizes.h"

namespace ovimap::bench {
namespace {

constexpr std::size_t kTop = 10;
constexpr std::int64_t kVocabulary = 372;

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

/// All that follows the encoding of a text: cosines, standard scores, ranking, verdict.
void answer_query(benchmark::State& state) {
  const SearchIndex index = random_index(state.range(0), state.range(1));
  const SearchIndex vocabulary = random_index(kVocabulary, state.range(1));
  const ScoreCalibration calibration(index, vocabulary.embeddings(), {});
  const Eigen::VectorXf query = index.embeddings().row(0).transpose();
  for (auto _ : state) {
    const Eigen::VectorXf scores = calibration.standard_scores(index.cosines(query));
    const auto best = index.best(scores, kTop);
    for (const std::size_t position : best)
      benchmark::DoNotOptimize(calibration.null_distribution().p_value(
          double{scores[static_cast<Eigen::Index>(position)]}));
  }
}
BENCHMARK(answer_query)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->ArgsProduct({{100, 1000, 10000, 100000}, {384, 768}});

/// A direction of its own for each text, at no cost.
class HashEncoder : public ImageTextEncoder {
 public:
  explicit HashEncoder(int dimension) : identity_{"hash", dimension, ""} {}

  const EncoderIdentity& identity() const override { return identity_; }
  std::optional<MatchCalibration> calibration() const override { return std::nullopt; }
  Embeddings encode_images(std::span<const RgbImage>) override { return {}; }
  Embeddings encode_texts(std::span<const std::string> texts) override {
    Embeddings rows(static_cast<Eigen::Index>(texts.size()), identity_.dimension);
    for (std::size_t i = 0; i < texts.size(); ++i) {
      std::minstd_rand engine(static_cast<std::uint32_t>(std::hash<std::string>()(texts[i])));
      std::normal_distribution<float> normal;
      auto row = rows.row(static_cast<Eigen::Index>(i));
      for (float& number : row) number = normal(engine);
      row.normalize();
    }
    return rows;
  }

 private:
  EncoderIdentity identity_;
};

/// The same with what size and place say, and against all other household words.
void answer_with_evidence(benchmark::State& state) {
  const SearchIndex index = random_index(state.range(0), state.range(1));
  std::minstd_rand engine(2);
  std::uniform_real_distribution<float> metres(0.05f, 2.f);
  std::vector<ObjectMeasures> measures(index.size());
  for (ObjectMeasures& object : measures)
    object = {metres(engine), metres(engine), metres(engine), metres(engine), 0.5f, 0.3f};
  HashEncoder encoder(static_cast<int>(state.range(1)));
  const TextMatcher matcher(index, encoder, {}, {}, measures);
  for (auto _ : state)
    benchmark::DoNotOptimize(index.best(matcher.match({"chair"}, {}).standard, kTop));
}
BENCHMARK(answer_with_evidence)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->ArgsProduct({{100, 1000, 10000}, {384}});

/// How one object's measures fit all names: what opening a map costs for each object.
void fit_sizes(benchmark::State& state) {
  const std::vector<ThingSize>& things = builtin_thing_sizes();
  for (auto _ : state)
    benchmark::DoNotOptimize(size_likelihoods({0.3f, 0.5f, 0.4f, 0.7f, 0.5f, 0.3f}, things));
}
BENCHMARK(fit_sizes)->Unit(benchmark::kMicrosecond);

/// Once per map and encoder.
void calibrate(benchmark::State& state) {
  const SearchIndex index = random_index(state.range(0), state.range(1));
  const SearchIndex vocabulary = random_index(kVocabulary, state.range(1));
  for (auto _ : state)
    benchmark::DoNotOptimize(ScoreCalibration(index, vocabulary.embeddings(), {}));
}
BENCHMARK(calibrate)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->ArgsProduct({{100, 1000, 10000}, {384}});

}  // namespace
}  // namespace ovimap::bench
