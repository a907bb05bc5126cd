// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/revise/reembed.h"

#include <gtest/gtest.h>

#include "ovimap/pipeline/mapping/desk_fixture.h"
#include "ovimap/pipeline/sequence/sequence_run.h"
#include "ovimap/semantics/views/color_encoder_fixture.h"

namespace ovimap {
namespace {

SemanticRecord map_desk(std::shared_ptr<ImageTextEncoder> encoder, int kept_views) {
  const DeskScene scene;
  MapperConfig config;
  config.view_interval = 1;
  config.semantics.views.min_mask_px = 60;
  config.semantics.views.min_first_depth_px = 40;
  config.semantics.crops.kept_views = kept_views;
  Mapper mapper(config, std::make_shared<DeskMasks>(), std::move(encoder));
  const SequenceResult result = run_sequence(scene, positions({}, scene.size()), mapper);
  return make_document(std::move(mapper), result, {"desk"}).semantics;
}

TEST(Reembed, GivesWhatTheEncoderWouldHaveGivenWhileMapping) {
  const SemanticRecord direct = map_desk(std::make_shared<ColorEncoder>(), 100);
  SemanticRecord later = map_desk(nullptr, 100);
  EXPECT_EQ(later.encoder.name, "");
  ColorEncoder encoder;
  std::size_t told = 0;
  const ReembedSummary summary =
      reembed(later, encoder, [&](std::size_t done, std::size_t) { told = done; });
  EXPECT_EQ(told, later.looks.size());
  const auto has_views = [](const auto& look) { return !look.second.views.empty(); };
  EXPECT_EQ(static_cast<std::ptrdiff_t>(summary.super_points),
            std::count_if(direct.looks.begin(), direct.looks.end(), has_views));
  EXPECT_EQ(summary.dropped, 0u);
  EXPECT_EQ(later.encoder, encoder.identity());
  for (const auto& [id, look] : direct.looks) {
    const auto& views = later.looks.at(id).views;
    ASSERT_EQ(views.size(), look.views.size());
    for (std::size_t i = 0; i < views.size(); ++i)  // crops went through a JPEG
      EXPECT_GT(views[i].embedding.dot(look.views[i].embedding), 0.995f);
  }
}

TEST(Reembed, DropsEmbeddingsOfAnotherSpaceWhereNoCropWasKept) {
  SemanticRecord record = map_desk(std::make_shared<ColorEncoder>(), 1);
  ColorEncoder encoder;
  const ReembedSummary summary = reembed(record, encoder);
  const auto has_views = [](const auto& look) { return !look.second.views.empty(); };
  EXPECT_EQ(static_cast<std::ptrdiff_t>(summary.views),
            std::count_if(record.looks.begin(), record.looks.end(), has_views));
  EXPECT_GT(summary.dropped, 0u);
  for (const auto& [id, look] : record.looks)
    for (const ObjectView& view : look.views)
      EXPECT_EQ(view.embedding.size() > 0, !view.crop.empty());
}

TEST(Reembed, SaysWhenThereIsNothingToEmbedAndKeepsWhatWasThere) {
  SemanticRecord record = map_desk(std::make_shared<ColorEncoder>(), 0);
  ColorEncoder encoder;
  EXPECT_THROW(reembed(record, encoder), Error);
  record = map_desk(std::make_shared<ColorEncoder>(), 4);
  std::erase_if(record.looks, [](const auto& look) { return look.second.views.empty(); });
  record.looks.rbegin()->second.views.front().crop = {{1, 2, 3}, {4}, {}};
  EXPECT_THROW(reembed(record, encoder), Error);
  EXPECT_GT(record.looks.begin()->second.views.front().embedding.size(), 0);
}

}  // namespace
}  // namespace ovimap
