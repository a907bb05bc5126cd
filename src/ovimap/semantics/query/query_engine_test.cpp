// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/query/query_engine.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "ovimap/base/config.h"
#include "ovimap/base/error_fixture.h"
#include "ovimap/semantics/query/query_fixture.h"

namespace ovimap {
namespace {

const std::vector<std::string> kRoomThings{"table", "red chair", "blue chair", "mug",
                                           "sofa",  "armchair",  "",           "television",
                                           "lamp",  "red book",  "blue book",  "plate"};

class QueryEngineTest : public ::testing::Test {
 protected:
  std::vector<InstanceId> ids(const QueryAnswer& answer) const {
    std::vector<InstanceId> list;
    for (const QueryMatch& match : answer.matches) list.push_back(match.id);
    return list;
  }
  InstanceId best(const QueryEngine& engine, const std::string& text,
                  const std::vector<std::string>& negatives = {}) const {
    return engine.find({text, negatives}).matches.front().id;
  }

  WordEncoder encoder_;
  SearchIndex index_ = map_of(kRoomThings);
};

TEST_F(QueryEngineTest, FindsWhatIsThereAndSaysWhatIsNot) {
  const QueryEngine engine(index_, &encoder_);
  for (const char* text : {"table", "mug", "television", "red chair", "sofa"}) {
    const QueryAnswer answer = engine.find({text, {}});
    EXPECT_EQ(answer.verdict, Verdict::kFound) << text;
    EXPECT_EQ(kRoomThings[answer.matches[0].position], text);
    EXPECT_GT(*answer.matches[0].probability, 0.7);
    EXPECT_GT(answer.matches[0].score, 0.5f);
    EXPECT_LE(*answer.matches[0].p_value, 0.05);
  }
  for (const char* text : {"elephant", "swimming pool", "helicopter"}) {
    const QueryAnswer answer = engine.find({text, {}});
    EXPECT_EQ(answer.verdict, Verdict::kNotInMap) << text;
    EXPECT_EQ(answer.matches.size(), 5u);  // what comes nearest is shown all the same
    EXPECT_GT(*answer.matches[0].p_value, 0.05);
  }
}

TEST_F(QueryEngineTest, SaysThatMaterialsAreNotJudged) {
  const QueryEngine engine(index_, &encoder_);
  EXPECT_EQ(engine.find({"wooden table", {}}).reason, "not judged: wooden");
  EXPECT_EQ(engine.find({"striped sofa, wooden table", {}}).reason, "not judged: striped, wooden");
  const std::string both = engine.find({"metal mug nearest to the wooden table", {}}).reason;
  EXPECT_TRUE(both.ends_with("not judged: metal, wooden")) << both;
  EXPECT_EQ(engine.find({"table", {}}).reason, "");
}

TEST_F(QueryEngineTest, OnlySomeMayBeTheAnswer) {
  const QueryEngine engine(index_, &encoder_);
  Query query{"red chair", {}};
  query.among.assign(kRoomThings.size(), true);
  query.among[1] = false;
  const QueryAnswer other = engine.find(query);
  for (const InstanceId id : ids(other)) EXPECT_NE(id, 2u) << "it may not be";
  query.among.assign(kRoomThings.size(), false);
  query.among[1] = query.among[3] = true;
  EXPECT_EQ(engine.find(query).verdict, Verdict::kFound);
  EXPECT_EQ(engine.find(query).matches.size(), 2u);
  query.text = "highest thing";
  EXPECT_EQ(engine.find(query).matches.front().id, 2u) << "of those that may be";
  query.text = "object near the sofa";  // which may be any
  for (const QueryMatch& match : engine.find(query).matches)
    EXPECT_TRUE(query.among[match.position]);
  query.among.assign(kRoomThings.size(), false);
  for (const char* text : {"mug", "largest mug", "lowest thing"}) {
    query.text = text;
    EXPECT_EQ(engine.find(query).verdict, Verdict::kNotInMap) << text;
    EXPECT_TRUE(engine.find(query).matches.empty()) << text;
  }
}

TEST_F(QueryEngineTest, NeedsAsManyWordsAsTheVerdictDoes) {
  QueryConfig config;
  config.verdict.min_references = 100000;
  const std::string fault = error_of([&] {
    (void)QueryEngine(index_, &encoder_, config).find({"mug", {}});
  });
  EXPECT_NE(fault.find("verdict.min_references is 100000"), std::string::npos);
}

TEST_F(QueryEngineTest, RanksBothObjectsOfAKind) {
  QueryConfig config;
  config.top_k = 2;
  const QueryEngine engine(index_, &encoder_, config);
  std::vector<InstanceId> chairs = ids(engine.find({"chair", {}}));
  std::sort(chairs.begin(), chairs.end());
  EXPECT_EQ(chairs, (std::vector<InstanceId>{2, 3}));
}

TEST_F(QueryEngineTest, ObjectsWithoutEmbeddingNeverAppear) {
  QueryConfig config;
  config.top_k = 100;
  const QueryEngine engine(index_, &encoder_, config);
  const QueryAnswer answer = engine.find({"mug", {}, true});
  EXPECT_EQ(answer.matches.size(), kRoomThings.size() - 1);
  for (const QueryMatch& match : answer.matches) EXPECT_NE(match.position, 6u);
  ASSERT_EQ(answer.relevance.size(), 12);
  EXPECT_EQ(answer.relevance[6], 0.f);
  EXPECT_GT(answer.relevance[3], 0.7f);
  EXPECT_GE(answer.relevance.minCoeff(), 0.f);
  EXPECT_LE(answer.relevance.maxCoeff(), 1.f);
}

TEST_F(QueryEngineTest, AnyAndAll) {
  QueryConfig config;
  config.top_k = 3;
  const QueryEngine any(index_, &encoder_, config);
  std::vector<InstanceId> found = ids(any.find({"mug, sofa, plate", {}}));
  std::sort(found.begin(), found.end());
  EXPECT_EQ(found, (std::vector<InstanceId>{4, 5, 12}));
  config.terms = TermRule::kAll;
  const QueryEngine all(index_, &encoder_, config);
  EXPECT_EQ(best(all, "red, chair"), 2u);
  EXPECT_EQ(best(all, "book, blue"), 11u);
  EXPECT_EQ(all.find({"red, television", {}}).verdict, Verdict::kNotInMap);
}

TEST_F(QueryEngineTest, MoreAlternativesMustMatchBetter) {
  const QueryEngine engine(index_, &encoder_);
  const double one = *engine.find({"mug", {}}).matches[0].p_value;
  const double two = *engine.find({"mug, zeppelin", {}}).matches[0].p_value;
  EXPECT_NEAR(two, 1.0 - (1.0 - one) * (1.0 - one), 1e-9);
}

TEST_F(QueryEngineTest, NegativesExcludeOrLower) {
  QueryConfig config;
  config.top_k = 100;
  const QueryEngine engine(index_, &encoder_, config);
  EXPECT_EQ(best(engine, "chair", {"red chair"}), 3u);
  EXPECT_EQ(best(engine, "chair", {"blue chair"}), 2u);
  const QueryAnswer none = engine.find({"chair", {"red chair", "blue chair"}});
  EXPECT_EQ(none.verdict, Verdict::kNotInMap);
  for (const QueryMatch& match : none.matches) EXPECT_NE(match.id, 2u);
  config.negatives = NegativeRule::kLower;
  const QueryEngine lower(index_, &encoder_, config);
  const QueryAnswer lowered = lower.find({"chair", {"red chair"}});
  EXPECT_EQ(lowered.matches[0].id, 3u);
  EXPECT_EQ(lowered.matches.size(), kRoomThings.size() - 1);
}

TEST_F(QueryEngineTest, UsesTheModelsOwnProbability) {
  encoder_.calibration_ = MatchCalibration{20.f, -10.f};
  const QueryEngine engine(index_, &encoder_);
  const QueryMatch match = engine.find({"mug", {}}).matches[0];
  EXPECT_NEAR(*match.probability, 1.0 / (1.0 + std::exp(10.0 - 20.0 * double{match.score})), 1e-6);
}

TEST_F(QueryEngineTest, MoreLikeThisLeavesItselfOut) {
  const QueryEngine without_encoder(index_, nullptr);
  const QueryAnswer like_red_chair = without_encoder.find_like(2);
  EXPECT_EQ(like_red_chair.query, "#2");
  EXPECT_EQ(like_red_chair.verdict, Verdict::kFound);
  EXPECT_FALSE(like_red_chair.matches[0].probability.has_value());  // too few objects to calibrate
  for (const QueryMatch& match : like_red_chair.matches) EXPECT_NE(match.id, 2u);
  const InstanceId best_id = like_red_chair.matches[0].id;
  EXPECT_TRUE(best_id == 3u || best_id == 10u);  // the other chair or the other red thing
  EXPECT_THROW(without_encoder.find({"mug", {}}), Error);
  EXPECT_THROW(without_encoder.find_like(77), Error);
  EXPECT_THROW(without_encoder.find_like(7), Error);  // no embedding
}

TEST_F(QueryEngineTest, LooksForAPicture) {
  std::vector<std::string> things = TextMatcher::vocabulary_texts();
  things.resize(60);
  const SearchIndex index = map_of(things);
  const QueryEngine engine(index, &encoder_);
  const QueryAnswer found = engine.find_like(WordEncoder::picture_of(things[17]), "cup.jpg");
  EXPECT_EQ(found.query, "cup.jpg");
  EXPECT_EQ(found.verdict, Verdict::kFound);
  EXPECT_EQ(found.matches[0].position, 17u);
  EXPECT_EQ(engine.find_like(WordEncoder::picture_of("zeppelin"), "z").verdict, Verdict::kNotInMap);
  EXPECT_THROW(engine.find_like(RgbImage(3, 3, Rgb8{32, 0, 0}), "blank"), Error);  // zero embedding
}

TEST_F(QueryEngineTest, RankingByCosineIsAChoice) {
  QueryConfig config;
  ConfigFields fields;
  list_fields(config, fields);
  fields.set("rank_by", "cosine");
  fields.set("verdict.false_positive_rate", "0.01");
  EXPECT_EQ(config.rank_by, RankRule::kCosine);
  const QueryEngine engine(index_, &encoder_, config);
  const QueryAnswer answer = engine.find({"book", {}});
  for (std::size_t i = 1; i < answer.matches.size(); ++i)
    EXPECT_GE(answer.matches[i - 1].score, answer.matches[i].score);
}

TEST_F(QueryEngineTest, EncodesTheVocabularyOnce) {
  const QueryEngine first(index_, &encoder_);
  const int words = encoder_.texts_encoded;
  EXPECT_GE(words, 300);
  const QueryEngine second(index_, &encoder_, {}, first.matcher()->vocabulary());
  const auto lists = static_cast<int>(TextEvidence::texts().size());
  EXPECT_EQ(encoder_.texts_encoded, words + lists);  // which remember_text_lists() remembers
  const auto a = first.find({"mug", {}}).matches, b = second.find({"mug", {}}).matches;
  EXPECT_EQ(a[0].p_value, b[0].p_value);
}

TEST_F(QueryEngineTest, RefusesBadInput) {
  const QueryEngine engine(index_, &encoder_);
  EXPECT_THROW(engine.find({"", {}}), Error);
  EXPECT_THROW(engine.find({" , ", {}}), Error);
  EXPECT_THROW(engine.find({std::string(10000, 'a'), {}}), Error);
  EXPECT_THROW(engine.find({"mug", {""}}), Error);
  std::string many = "mug";
  for (int i = 0; i < 63; ++i) many += ",mug";
  EXPECT_NO_THROW(engine.find({many, {}}));
  EXPECT_THROW(engine.find({many, {"chair"}}), Error) << "64 things are enough";
  const SearchIndex bare = map_of({"", ""});
  EXPECT_THROW(QueryEngine(bare, &encoder_), Error);
  EXPECT_THROW(QueryEngine(SearchIndex(), &encoder_), Error);
  encoder_.identity_.dimension = 768;
  EXPECT_THROW(QueryEngine(index_, &encoder_), Error);
  encoder_.identity_.dimension = WordEncoder::kDimension;
  QueryConfig config;
  config.prompts = "no slot";
  EXPECT_THROW(QueryEngine(index_, &encoder_, config), Error);
}

StoredCrop plain_crop(Rgb8 color) {
  ObjectCrop crop;
  crop.image = RgbImage(16, 16, color);
  crop.mask = Image<std::uint8_t>(16, 16, 1);
  crop.object_px = {Eigen::Vector2i(0, 0), Eigen::Vector2i(15, 15)};
  return store_crop(crop, {});
}

class AttributesTest : public ::testing::Test {
 protected:
  AttributesTest() {
    scene_ = scene_of_boxes(index_, Eigen::Vector3f::UnitZ());
    scene_.colors = std::make_shared<const ObjectColors>([this] {
      std::vector<StoredCrop> crops(index_.size(), plain_crop({235, 235, 235}));
      crops[0] = plain_crop({190, 30, 35});
      crops[1] = plain_crop({40, 80, 180});
      crops[7] = plain_crop({25, 40, 100});
      return crops;
    });
    QueryConfig config;
    config.evidence.size_weight = 0.f;  // these boxes are no furniture
    engine_.emplace(index_, &encoder_, config, Embeddings{}, scene_);
  }
  std::vector<InstanceId> ids(const std::string& text) const {
    std::vector<InstanceId> list;
    for (const QueryMatch& match : engine_->find({text, {}}).matches) list.push_back(match.id);
    return list;
  }

  WordEncoder encoder_;
  SearchIndex index_ = map_of({"chair", "chair", "chair", "table", "mug", "lamp", "door", "sofa"},
                              {{Eigen::Vector3f(0, 0, 0), Eigen::Vector3f(0.5f, 0.5f, 0.8f)},
                               {Eigen::Vector3f(2, 0, 0), Eigen::Vector3f(2.5f, 0.5f, 0.8f)},
                               {Eigen::Vector3f(4, 0, 0), Eigen::Vector3f(4.5f, 0.5f, 1.3f)},
                               {Eigen::Vector3f(6, 0, 0), Eigen::Vector3f(8, 1, 0.7f)},
                               {Eigen::Vector3f(6, 0, 0.7f), Eigen::Vector3f(6.1f, 0.1f, 0.8f)},
                               {Eigen::Vector3f(9, 0, 0), Eigen::Vector3f(9.3f, 0.3f, 1.5f)},
                               {Eigen::Vector3f(10, 0, 0), Eigen::Vector3f(11, 0.1f, 2)},
                               {Eigen::Vector3f(12, 0, 0), Eigen::Vector3f(14, 1, 0.8f)}});
  QueryScene scene_;
  std::optional<QueryEngine> engine_;
};

TEST_F(AttributesTest, ColorsAreThoseOfTheSurface) {
  EXPECT_EQ(ids("red chair").front(), 1u);
  EXPECT_EQ(ids("blue chair").front(), 2u);
  EXPECT_EQ(ids("white chair").front(), 3u);
  const QueryAnswer green = engine_->find({"green chair", {}});
  EXPECT_EQ(green.verdict, Verdict::kNotInMap);
  const QueryAnswer red = engine_->find({"red chair", {}});
  EXPECT_EQ(red.verdict, Verdict::kFound);
  EXPECT_NE(red.matches[0].evidence.find("% red"), std::string::npos);
}

TEST_F(AttributesTest, ShadesAreHowLightTheColorIs) {
  const QueryAnswer dark = engine_->find({"dark blue sofa", {}});
  EXPECT_EQ(dark.verdict, Verdict::kFound);
  EXPECT_NE(dark.matches[0].evidence.find("% light"), std::string::npos);
  EXPECT_EQ(engine_->find({"light blue sofa", {}}).verdict, Verdict::kNotInMap);
  EXPECT_EQ(engine_->find({"blue sofa", {}}).verdict, Verdict::kFound);
}

TEST_F(AttributesTest, SizesAreMeasured) {
  EXPECT_EQ(ids("chair taller than 1 m").front(), 3u);
  EXPECT_EQ(engine_->find({"table longer than 1.5 m", {}}).verdict, Verdict::kFound);
  EXPECT_EQ(engine_->find({"table longer than 3 m", {}}).verdict, Verdict::kNotInMap);
}

TEST_F(AttributesTest, ThingsAreCounted) {
  const QueryAnswer chairs = engine_->find({"how many chairs", {}});
  ASSERT_TRUE(chairs.count);
  EXPECT_EQ(chairs.count->found, 3);
  EXPECT_NEAR(chairs.count->expected, 3.0, 1.0);
  EXPECT_EQ(chairs.matches.size(), 3u);
  EXPECT_EQ(engine_->find({"two chairs", {}}).verdict, Verdict::kFound);
  EXPECT_EQ(engine_->find({"two chairs", {}}).matches.size(), 2u);
  const QueryAnswer all = engine_->find({"all the chairs", {}});
  ASSERT_TRUE(all.count);
  EXPECT_EQ(all.count->found, 3);
  EXPECT_EQ(all.reading, "all [chair]");
  EXPECT_EQ(all.matches[0].standard_score, engine_->find({"chair", {}}).matches[0].standard_score);
  EXPECT_FALSE(engine_->find({"the chair", {}}).count);
  const QueryAnswer tables = engine_->find({"two tables", {}});
  EXPECT_EQ(tables.verdict, Verdict::kNotInMap);
  EXPECT_EQ(tables.reason, "only 1 of 2");
}

}  // namespace
}  // namespace ovimap
