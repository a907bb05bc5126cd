// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/masks/id_mask_sources.h"

#include <gtest/gtest.h>

#include "ovimap/base/config.h"
#include "ovimap/frames/frame/frame_source.h"
#include "ovimap/image/codec.h"
#include "ovimap/inference/mask_source_factory.h"
#include "ovimap/inference/models/test_support.h"

namespace ovimap {
namespace {

/// Three small frames named shot-010.color, shot-020.color, shot-030.color; the second has truth.
class TestFrames : public FrameSource {
 public:
  explicit TestFrames(bool truth) : truth_(truth) {}
  std::string kind() const override { return "test"; }
  std::int64_t size() const override { return 3; }
  FrameRead read(std::int64_t position) const override {
    Frame frame;
    frame.index = position;
    frame.name = concat("shot-0", position + 1, "0.color");
    frame.color = RgbImage(4, 3);
    return {frame, ""};
  }
  std::optional<IdImage> truth_ids(std::int64_t position) const override {
    if (!truth_ || position != 1) return std::nullopt;
    IdImage ids(4, 3);
    ids.at(1, 1) = 70;
    return ids;
  }

 private:
  bool truth_;
};

void write_ids(const std::filesystem::path& file, int width, int height, std::uint16_t id) {
  write_file(file, encode_png(IdImage(width, height, id)));
}

Frame frame_at(std::int64_t position) {
  return *TestFrames(false).read(position).frame;
}

TEST(GtMaskSource, GivesTheTruth) {
  const TestFrames frames(true);
  const auto source = make_mask_source("gt", {}, {&frames, {}});
  EXPECT_EQ(source->kind(), "gt");
  const Entities entities = *source->entities(frame_at(1), {});
  EXPECT_EQ(entities.scores.size(), 1u);
  EXPECT_EQ(entities.ids.at(1, 1), 1);
  EXPECT_FALSE(source->entities(frame_at(0), {})) << "no true image: not masked";
  for (const std::int64_t index : {-1, 3}) {
    Frame other = frame_at(0);
    other.index = index;
    EXPECT_THROW(source->entities(other, {}), FrameError);
  }
}

TEST(KeptMaskSource, AsksOnlyOnce) {
  class Counting : public MaskSource {
   public:
    explicit Counting(int& asked) : asked_(asked) {}
    std::string kind() const override { return "counting"; }
    bool is_slow() const override { return true; }
    std::optional<Entities> entities(const Frame& frame, std::span<const MaskPrompt>) override {
      ++asked_;
      if (frame.index == 2) return std::nullopt;
      Entities found{IdImage(frame.color.width(), frame.color.height()), {0.5f, 0.25f}};
      found.ids.at(0, 0) = 2;
      found.ids.at(1, 0) = 1;
      return found;
    }

   private:
    int& asked_;
  };
  const fixture::TemporaryFolder folder;
  int asked = 0;
  for (int run = 0; run < 2; ++run) {
    KeptMaskSource source(folder.path() / "masks", std::make_unique<Counting>(asked));
    EXPECT_EQ(source.kind(), "counting");
    EXPECT_TRUE(source.is_slow());
    for (std::int64_t i = 0; i < 2; ++i) {
      const Entities entities = *source.entities(frame_at(i), {});
      EXPECT_EQ(entities.scores, (std::vector<float>{0.5f, 0.25f}));
      EXPECT_EQ(entities.ids.at(0, 0), 2);
      EXPECT_EQ(entities.ids.at(1, 0), 1);
    }
  }
  EXPECT_EQ(asked, 2);
  KeptMaskSource source(folder.path() / "masks", std::make_unique<Counting>(asked));
  EXPECT_FALSE(source.entities(frame_at(2), {})) << "not masked";
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "masks/2.png")) << "and so not kept";
  // What was kept is what any folder of masks is.
  EXPECT_EQ(DirMaskSource(folder.path() / "masks").entities(frame_at(1), {})->scores,
            (std::vector<float>{0.5f, 0.25f}));
}

TEST(GtMaskSource, NeedsTruth) {
  const TestFrames frames(false);
  EXPECT_TRUE(contains(error_of([&] {
                         make_mask_source("gt", {}, {&frames, {}});
                       }),
                       "this test source has none"));
  EXPECT_TRUE(contains(error_of([&] { make_mask_source("gt", {}, {}); }), "recorded source"));
}

TEST(DirMaskSource, FindsFilesByNameOrIndex) {
  for (const char* name :
       {"shot-020.color.png", "shot-020.png", "1.png", "000001.png", "mask_01.png"}) {
    const fixture::TemporaryFolder scratch;
    write_ids(scratch.path() / name, 4, 3, 9);
    const TestFrames frames(false);
    const auto source = make_mask_source(scratch.path().string(), {}, {&frames, {}});
    EXPECT_EQ(source->kind(), "dir");
    const Entities entities = *source->entities(frame_at(1), {});
    EXPECT_EQ(entities.scores.size(), 1u) << name;
    EXPECT_EQ(entities.ids.at(3, 2), 1) << name;
    EXPECT_FALSE(source->entities(frame_at(0), {})) << name;
  }
}

TEST(DirMaskSource, AFileWithoutEntitiesIsAMaskAndNoFileIsNone) {
  const fixture::TemporaryFolder scratch;
  write_ids(scratch.path() / "0.png", 4, 3, 0);
  DirMaskSource source(scratch.path());
  const std::optional<Entities> nothing = source.entities(frame_at(0), {});
  ASSERT_TRUE(nothing.has_value());
  EXPECT_TRUE(nothing->scores.empty());
  EXPECT_EQ(nothing->ids.width(), 4);
  EXPECT_FALSE(source.entities(frame_at(1), {}).has_value());
}

TEST(DirMaskSource, NamesFileAndBothSizes) {
  const fixture::TemporaryFolder scratch;
  write_ids(scratch.path() / "0.png", 5, 3, 1);
  DirMaskSource source(scratch.path());
  const std::string message = error_of([&] { source.entities(frame_at(0), {}); });
  EXPECT_TRUE(contains(message, "0.png is 5x3")) << message;
  EXPECT_TRUE(contains(message, "is 4x3")) << message;
}

TEST(DirMaskSource, TakesTheScoresOfTheIdsThatItSees) {
  const fixture::TemporaryFolder scratch;
  IdImage ids(4, 3);
  ids.at(0, 0) = 2;
  ids.at(1, 0) = 5;
  write_file(scratch.path() / "0.png", encode_png(ids));
  scratch.write("0.json", R"({"scores": [0.1, 0.2, 0.3, 0.4, 0.5, 0.6]})");
  const Entities entities = *DirMaskSource(scratch.path()).entities(frame_at(0), {});
  EXPECT_EQ(entities.scores, (std::vector<float>{0.2f, 0.5f}));
  EXPECT_EQ(entities.ids.at(0, 0), 1);
  EXPECT_EQ(entities.ids.at(1, 0), 2);
}

TEST(DirMaskSource, RefusesScoresThatAreNone) {
  const fixture::TemporaryFolder scratch;
  write_ids(scratch.path() / "0.png", 4, 3, 2);
  DirMaskSource source(scratch.path());
  for (const auto& [text, what] : {std::pair{"[1, 1]", "no list of scores"},
                                   {R"({"scores": 1})", "no list of scores"},
                                   {R"({"scores": [1, 2]})", "what is no score"},
                                   {R"({"scores": [1, "x"]})", "what is no"},
                                   {R"({"scores": [1]})", "1 scores, but 0.png has id 2"},
                                   {"{", "0.json"}}) {
    scratch.write("0.json", text);
    const std::string message = error_of([&] { source.entities(frame_at(0), {}); });
    EXPECT_TRUE(contains(message, what)) << message;
    EXPECT_TRUE(contains(message, "0.json")) << message;
  }
}

TEST(DirMaskSource, RefusesColourMasks) {
  const fixture::TemporaryFolder scratch;
  write_file(scratch.path() / "0.png", encode_png(RgbImage(4, 3)));
  DirMaskSource source(scratch.path());
  EXPECT_TRUE(contains(error_of([&] { source.entities(frame_at(0), {}); }), "0.png"));
}

TEST(DirMaskSource, RefusesAFolderThatFitsNoFrame) {
  const fixture::TemporaryFolder scratch;
  const TestFrames frames(false);
  EXPECT_TRUE(contains(error_of([&] { DirMaskSource(scratch.path(), &frames); }), "holds no .png"));
  write_ids(scratch.path() / "shot-099.png", 4, 3, 1);
  const std::string message = error_of([&] { DirMaskSource(scratch.path(), &frames); });
  EXPECT_TRUE(contains(message, "no file for any of the 3 frames")) << message;
  EXPECT_TRUE(contains(message, "shot-010.color.png")) << message;
  EXPECT_TRUE(
      contains(error_of([&] { DirMaskSource(scratch.path() / "absent"); }), "does not exist"));
}

TEST(MakeMaskSource, KnowsNoneModelsAndNothingElse) {
  EXPECT_EQ(make_mask_source("none", {}), nullptr);
  MaskSourceContext context;
  context.model_dirs = {inference_testdata() / "golden_sam"};
  EXPECT_EQ(make_mask_source("sam2", {}, context)->kind(), "sam");
  EXPECT_EQ(make_mask_source((inference_testdata() / "golden_entity").string(), {})->kind(),
            "entity");
  EXPECT_TRUE(contains(error_of([&] { make_mask_source("no such model", {}, context); }),
                       "model 'no such model' was not found"));
}

TEST(MakeMaskSource, RefusesAModelOfAnotherKind) {
  const fixture::TemporaryFolder scratch;
  scratch.write("model.yaml", "kind: dual_encoder\nname: n\nlicense: l\nsource: s\n");
  EXPECT_TRUE(contains(error_of([&] { make_mask_source(scratch.path().string(), {}); }),
                       "of kind 'dual_encoder'; as a source of masks sam and entity are accepted"));
}

TEST(MaskSourceConfig, ListsEveryKindsFields) {
  MaskSourceConfig config;
  ConfigFields fields;
  list_fields(config, fields);
  fields.set("sam.max_decoder_prompts", "12");
  fields.set("entity.min_score", "0.25");
  fields.set("runtime.threads", "2");
  EXPECT_EQ(config.sam.max_decoder_prompts, 12);
  EXPECT_FLOAT_EQ(config.entity.min_score, 0.25f);
  EXPECT_EQ(config.runtime.threads, 2);
  for (const ConfigField& field : fields.fields())  // each default is one of the accepted values
    EXPECT_NO_THROW(field.set(field.get())) << field.name;
}

}  // namespace
}  // namespace ovimap
