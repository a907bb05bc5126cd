// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/query/verdict.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "ovimap/base/config.h"
#include "ovimap/base/parallel.h"

namespace ovimap {
namespace {

constexpr Eigen::Index kDimension = 96;

/// A made world of words and objects. Words are random directions; an object is the mean of its
/// word, a direction that all objects share (what makes some objects near every text) and noise.
class MadeWorld {
 public:
  explicit MadeWorld(unsigned seed) : engine_(seed), shared_(random_row()) {}

  Eigen::VectorXf random_row() {
    std::normal_distribution<float> normal;
    return Eigen::VectorXf::NullaryExpr(kDimension, [&] { return normal(engine_); }).normalized();
  }

  Embeddings words(Eigen::Index count) {
    Embeddings rows(count, kDimension);
    for (Eigen::Index i = 0; i < count; ++i) rows.row(i) = word().transpose();
    return rows;
  }

  /// Words lean towards the shared direction too, so that hubs matter.
  Eigen::VectorXf word() { return (random_row() + 0.6f * shared_).normalized(); }

  Eigen::VectorXf object_of(const Eigen::VectorXf& word_of_it) {
    std::uniform_real_distribution<float> hub(0.f, 1.5f), noise(0.3f, 0.9f);
    return (word_of_it + hub(engine_) * shared_ + noise(engine_) * random_row()).normalized();
  }

  SearchIndex index(const Embeddings& words_of_objects) {
    Embeddings rows(words_of_objects.rows(), kDimension);
    std::vector<SearchObject> objects(static_cast<std::size_t>(rows.rows()));
    for (Eigen::Index i = 0; i < rows.rows(); ++i) {
      rows.row(i) = object_of(words_of_objects.row(i).transpose()).transpose();
      objects[static_cast<std::size_t>(i)].id = static_cast<InstanceId>(i + 1);
    }
    return SearchIndex(std::move(objects), rows);
  }

  const Eigen::VectorXf& shared() const { return shared_; }

 private:
  std::mt19937 engine_;
  Eigen::VectorXf shared_;
};

double best_p_value(const SearchIndex& index, const ScoreCalibration& calibration,
                    const Eigen::VectorXf& query) {
  const Eigen::VectorXf scores = calibration.standard_scores(index.cosines(query));
  const std::size_t best = index.best(scores, 1).front();
  return calibration.null_distribution().p_value(double{scores[static_cast<Eigen::Index>(best)]});
}

double share_found(const SearchIndex& index, const ScoreCalibration& calibration,
                   const Embeddings& queries, double rate) {
  int found = 0;
  for (Eigen::Index i = 0; i < queries.rows(); ++i)
    found += best_p_value(index, calibration, queries.row(i).transpose()) <= rate;
  return static_cast<double>(found) / static_cast<double>(queries.rows());
}

Embeddings stacked(const Embeddings& above, const Embeddings& below) {
  Embeddings both(above.rows() + below.rows(), above.cols());
  both << above, below;
  return both;
}

TEST(NullDistribution, IsTheLargestOfNormalScores) {
  NullDistribution null{2.0, 0.5, {0.0, 1.0}, 0.0};
  EXPECT_NEAR(null.p_value(2.0), 0.5, 1e-9);
  EXPECT_NEAR(null.p_value(2.0 + 0.5 * 1.6448536269514722), 0.05, 1e-9);
  null.likeness.own_parts = 3.0;
  EXPECT_NEAR(null.p_value(2.0), 1.0 - 0.125, 1e-9);
  EXPECT_GT(null.p_value(2.0 + 0.5 * 20.0), 0.0);  // no cancellation far out
  EXPECT_NEAR(null.p_value(-100.0), 1.0, 1e-9);
  null.likeness.own_parts = 1.0;
  null.likeness.shared = 0.7;  // of one object it does not matter what it shares
  EXPECT_NEAR(null.p_value(2.0 + 0.5 * 1.6448536269514722), 0.05, 1e-6);
}

TEST(NullDistribution, AgreesWithSimulation) {
  std::mt19937 engine(6);
  std::normal_distribution<double> normal;
  const NullDistribution null{1.0, 2.0, {0.4, 12.0}, 0.0};
  constexpr int kRuns = 100000;
  const double level = null.score_at(0.1);
  EXPECT_NEAR(null.p_value(level), 0.1, 1e-9);
  int above = 0;
  for (int run = 0; run < kRuns; ++run) {
    double largest = -1e9;
    for (int k = 0; k < 12; ++k) largest = std::max(largest, normal(engine));
    const double score = std::sqrt(0.4) * normal(engine) + std::sqrt(0.6) * largest;
    above += 1.0 + 2.0 * score >= level;
  }
  EXPECT_NEAR(static_cast<double>(above) / kRuns, 0.1, 0.004);
}

TEST(FitNull, RecoversTheBulkDespiteWhatIsPresent) {
  std::mt19937 engine(5);
  std::normal_distribution<double> normal;
  for (const double present : {0.0, 0.1, 0.3}) {
    std::vector<double> best;
    for (int i = 0; i < 4000; ++i) {
      double largest = -1e9;
      for (int k = 0; k < 8; ++k) largest = std::max(largest, normal(engine));
      best.push_back(i < present * 4000 ? 12.0 + normal(engine) : 1.0 + 2.0 * largest);
    }
    const NullDistribution null = fit_null(best, {0.0, 8.0}, {});
    EXPECT_NEAR(null.location, 1.0, 0.25) << present;
    EXPECT_NEAR(null.scale, 2.0, 0.25) << present;
    EXPECT_NEAR(null.present_share, present, 0.03);
  }
}

TEST(ScoreCalibration, KeepsTheFalsePositiveRateAndFindsWhatIsThere) {
  for (const float rate : {0.02f, 0.05f, 0.1f}) {
    double false_positives = 0, true_positives = 0;
    constexpr int kWorlds = 8;
    for (unsigned seed = 1; seed <= kWorlds; ++seed) {
      MadeWorld world(seed);
      const Embeddings present = world.words(40);
      const SearchIndex index = world.index(present);
      // Half of the words of the map are in the vocabulary too, as chairs and tables will be.
      const Embeddings references = stacked(present.topRows(20), world.words(300));
      VerdictConfig config;
      config.false_positive_rate = rate;
      const ScoreCalibration calibration(index, references, config);
      false_positives += share_found(index, calibration, world.words(500), double{rate});
      true_positives += share_found(index, calibration, present, double{rate});
    }
    // The correction of what is near everything takes from the upper tail: rather fewer than more.
    EXPECT_LT(false_positives / kWorlds, 1.2 * double{rate});
    EXPECT_GT(false_positives / kWorlds, 0.2 * double{rate});
    EXPECT_GT(true_positives / kWorlds, 0.97);
  }
}

TEST(ScoreCalibration, WorksForOneObjectAndForManyAlike) {
  MadeWorld world(3);
  const Embeddings vocabulary = world.words(300);
  const Embeddings chair = world.words(1);
  for (const Eigen::Index copies : {1, 50}) {
    const SearchIndex index = world.index(chair.replicate(copies, 1));
    const ScoreCalibration calibration(index, vocabulary, {});
    EXPECT_LT(best_p_value(index, calibration, chair.row(0).transpose()), 0.01) << copies;
    EXPECT_LT(share_found(index, calibration, world.words(400), 0.05), 0.12) << copies;
  }
}

TEST(ScoreCalibration, ATextNearEverythingFindsNothing) {
  MadeWorld world(11);
  const SearchIndex index = world.index(world.words(60));
  const Embeddings vocabulary = world.words(300);
  const Eigen::VectorXf near_all = (world.shared() + 0.3f * world.random_row()).normalized();
  const ScoreCalibration with(index, vocabulary, {});
  VerdictConfig off;
  off.common_level = 1.f;  // only what is nearer than every word of the vocabulary is corrected
  off.common_quantile = 0.f;
  const ScoreCalibration without(index, vocabulary, off);
  EXPECT_GT(best_p_value(index, with, near_all), best_p_value(index, without, near_all));
}

TEST(ScoreCalibration, CorrectsObjectsThatAreNearEveryText) {
  MadeWorld world(21);
  const Embeddings words = world.words(2);
  Embeddings rows(2, kDimension);
  rows.row(0) = (words.row(0) + 0.8f * world.random_row().transpose()).normalized();
  rows.row(1) = world.shared().transpose();  // a hub: nearer to word 0 than the object of word 0
  std::vector<SearchObject> objects(2);
  objects[0].id = 1;
  objects[1].id = 2;
  rows.row(0) -= 0.4f * world.shared().transpose();
  const SearchIndex index(objects, rows);
  const Eigen::VectorXf cosines = index.cosines(words.row(0).transpose());
  const ScoreCalibration calibration(index, world.words(300), {});
  const Eigen::VectorXf scores = calibration.standard_scores(cosines);
  EXPECT_GT(scores[0], scores[1] + 2.f);
}

TEST(ScoreCalibration, StandardScoresFollowTheirDefinition) {
  MadeWorld world(31);
  const SearchIndex index = world.index(world.words(3));
  const Embeddings references = world.words(64);
  VerdictConfig config;
  config.spread_shrinkage = 0.f;
  config.common_level = 1.f;
  const ScoreCalibration calibration(index, references, config);
  const Eigen::VectorXf query = references.row(5).transpose();
  const Eigen::VectorXf scores = calibration.standard_scores(index.cosines(query));
  for (Eigen::Index i = 0; i < 3; ++i) {
    double sum = 0, squares = 0;
    for (Eigen::Index j = 0; j < references.rows(); ++j) {
      const double cosine = double{index.embeddings().row(i).dot(references.row(j))};
      sum += cosine;
      squares += cosine * cosine;
    }
    const double mean = sum / 64, deviation = std::sqrt(squares / 64 - mean * mean);
    const double cosine = double{index.embeddings().row(i).dot(query)};
    EXPECT_NEAR(double{scores[i]}, (cosine - mean) / deviation, 2e-3);
  }
}

TEST(ScoreCalibration, ThreadsDoNotChangeABitAndObjectsWithoutEmbeddingDoNotCount) {
  MadeWorld world(41);
  const SearchIndex some = world.index(world.words(700));
  std::vector<SearchObject> objects = some.objects();
  Embeddings rows = stacked(some.embeddings(), Embeddings::Zero(100, kDimension));
  objects.resize(800);
  const SearchIndex index(objects, rows);
  const Embeddings references = world.words(100);
  const ScoreCalibration all(index, references, {});
  const Eigen::VectorXf cosines = index.cosines(world.word());
  const ThreadLimit one(1);
  const ScoreCalibration single(index, references, {});
  EXPECT_EQ(all.standard_scores(cosines), single.standard_scores(cosines));
  const ScoreCalibration without(some, references, {});
  EXPECT_EQ(all.null_distribution().location, single.null_distribution().location);
  EXPECT_FLOAT_EQ(static_cast<float>(all.null_distribution().location),
                  static_cast<float>(without.null_distribution().location));
}

TEST(ScoreCalibration, AReferenceDoesNotMatchItself) {
  MadeWorld world(51);
  const SearchIndex index = world.index(world.words(60));
  std::vector<std::size_t> own(60);
  for (std::size_t i = 0; i < own.size(); ++i) own[i] = i;
  const ScoreCalibration with_itself(index, index.embeddings(), {});
  const ScoreCalibration without(index, index.embeddings(), {}, own);
  EXPECT_GT(with_itself.null_distribution().location, without.null_distribution().location + 2.0);
}

TEST(MatchProbability, FallsFromOneToZero) {
  EXPECT_EQ(match_probability(0.0), 1.0);
  EXPECT_EQ(match_probability(1.0), 0.0);
  EXPECT_NEAR(match_probability(0.05), 1.0 / (1.0 + 0.40716), 1e-4);  // -e p ln p at 0.05
  EXPECT_NEAR(match_probability(1.0 / std::exp(1.0)), 0.5, 1e-12);
  double before = 1.0;
  for (int i = 1; i <= 1000; ++i) {
    const double now = match_probability(i / 1000.0);
    EXPECT_LT(now, before);
    before = now;
  }
}

TEST(VerdictConfig, ListsItsFields) {
  VerdictConfig config;
  ConfigFields fields;
  list_fields(config, fields);
  fields.set("false_positive_rate", "0.01");
  EXPECT_FLOAT_EQ(config.false_positive_rate, 0.01f);
  EXPECT_STREQ(verdict_name(Verdict::kNotInMap), "not_in_map");
  EXPECT_STREQ(verdict_name(Verdict::kFound), "found");
}

}  // namespace
}  // namespace ovimap
