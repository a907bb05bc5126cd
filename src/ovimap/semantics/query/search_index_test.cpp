// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/query/search_index.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>
#include <utility>

#include <gtest/gtest.h>

#include "ovimap/base/error.h"
#include "ovimap/base/parallel.h"

namespace ovimap {
namespace {

std::vector<SearchObject> numbered_objects(std::size_t count) {
  std::vector<SearchObject> objects(count);
  for (std::size_t i = 0; i < count; ++i) objects[i].id = static_cast<InstanceId>(i + 1);
  return objects;
}

Embeddings random_rows(Eigen::Index count, Eigen::Index dimension, unsigned seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<float> normal;
  return Embeddings::NullaryExpr(count, dimension, [&] { return normal(engine); });
}

TEST(SearchIndex, ScalesRowsAndGivesCosines) {
  Embeddings rows(3, 2);
  rows << 3, 4, 0, 0, 0, -2;
  const SearchIndex index(numbered_objects(3), std::move(rows));
  EXPECT_EQ(index.dimension(), 2);
  EXPECT_EQ(index.embedded(), 2u);
  EXPECT_FALSE(index.has_embedding(1));
  const Eigen::VectorXf cosines = index.cosines(Eigen::Vector2f(0, 10));
  EXPECT_NEAR(cosines[0], 0.8f, 5e-5f);
  EXPECT_FLOAT_EQ(cosines[1], 0.f);
  EXPECT_FLOAT_EQ(cosines[2], -1.f);
}

TEST(SearchIndex, AgreesWithTheNaiveProduct) {
  for (const Eigen::Index dimension : {1, 31, 32, 100, 384}) {
    const Embeddings rows = random_rows(2000, dimension, 7);
    const SearchIndex index(numbered_objects(2000), rows);
    const Eigen::VectorXf query = random_rows(1, dimension, 8).row(0).transpose();
    const Eigen::VectorXf fast = index.cosines(query);
    for (Eigen::Index i = 0; i < rows.rows(); ++i) {
      const Eigen::VectorXd row = rows.row(i).transpose().cast<double>();
      const double cosine = row.normalized().dot(query.cast<double>().normalized());
      ASSERT_NEAR(double{fast[i]}, cosine, 1e-4) << dimension << " " << i;
    }
  }
}

TEST(SearchIndex, FixedPointDoesNotOverflow) {
  // All of the length in one number, or spread evenly over very many.
  for (const Eigen::Index dimension : {1, 4, 16384}) {
    Embeddings rows = Embeddings::Ones(2, dimension);
    rows.row(1) *= -1.f;
    const Eigen::VectorXf cosines =
        SearchIndex(numbered_objects(2), rows).cosines(Eigen::VectorXf::Ones(dimension));
    EXPECT_NEAR(cosines[0], 1.f, 4e-3f) << dimension;  // 128 halves of a step at 16384
    EXPECT_NEAR(cosines[1], -1.f, 4e-3f) << dimension;
  }
}

TEST(SearchIndex, ThreadsDoNotChangeABit) {
  const SearchIndex index(numbered_objects(20000), random_rows(20000, 96, 3));
  const Eigen::VectorXf query = random_rows(1, 96, 4).row(0).transpose();
  const Eigen::VectorXf all = index.cosines(query);
  const ThreadLimit one(1);
  EXPECT_EQ(all, index.cosines(query));
}

TEST(SearchIndex, BestSortsLikeAFullSort) {
  const SearchIndex index(numbered_objects(500), random_rows(500, 8, 1));
  Eigen::VectorXf scores = random_rows(1, 500, 2).row(0).transpose();
  scores = (scores * 4.f).array().round();  // many ties
  std::vector<std::size_t> sorted(500);
  std::iota(sorted.begin(), sorted.end(), 0);
  std::stable_sort(sorted.begin(), sorted.end(), [&](std::size_t a, std::size_t b) {
    return scores[static_cast<Eigen::Index>(a)] > scores[static_cast<Eigen::Index>(b)];
  });
  sorted.resize(40);
  EXPECT_EQ(index.best(scores, 40), sorted);
  EXPECT_EQ(index.best(scores, 10000).size(), 500u);
  EXPECT_TRUE(index.best(scores, 0).empty());
}

TEST(SearchIndex, TiesGoToTheLowerIdWhateverTheOrder) {
  std::vector<SearchObject> objects(3);
  objects[0].id = 9;
  objects[1].id = 4;
  objects[2].id = 7;
  const SearchIndex index(objects, Embeddings::Ones(3, 2));
  EXPECT_EQ(index.best(Eigen::Vector3f(1, 1, 1), 3), (std::vector<std::size_t>{1, 2, 0}));
  EXPECT_EQ(index.find(7), std::size_t{2});
  EXPECT_EQ(index.find(8), std::nullopt);
}

TEST(SearchIndex, ObjectsWithoutEmbeddingAreNeverRanked) {
  Embeddings rows = -Embeddings::Ones(3, 2);
  rows.row(1).setZero();
  const SearchIndex index(numbered_objects(3), rows);
  const Eigen::VectorXf cosines = index.cosines(Eigen::Vector2f(1, 1));
  EXPECT_EQ(index.best(cosines, 3), (std::vector<std::size_t>{0, 2}));
}

TEST(SearchIndex, RefusesWhatDoesNotFit) {
  EXPECT_THROW(SearchIndex(numbered_objects(3), Embeddings::Ones(2, 4)), Error);
  Embeddings rows = Embeddings::Ones(2, 4);
  rows(1, 2) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(SearchIndex(numbered_objects(2), rows), Error);
}

TEST(SearchIndex, AnEmptyMapIsAnIndexToo) {
  const SearchIndex index;
  EXPECT_EQ(index.size(), 0u);
  EXPECT_TRUE(index.best(Eigen::VectorXf(), 5).empty());
}

}  // namespace
}  // namespace ovimap
