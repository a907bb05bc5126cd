// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/sequence/sequence_run.h"

#include <gtest/gtest.h>

#include "ovimap/base/error_fixture.h"
#include "ovimap/pipeline/mapping/desk_fixture.h"
#include "ovimap/pipeline/sequence/timings_text.h"

namespace ovimap {
namespace {

TEST(RunSequence, SkipsListsAndGoesOn) {
  DeskScene scene;
  scene.bad_frame = 3;
  Mapper mapper({});
  const SequenceResult result = run_sequence(scene, positions({}, scene.size()), mapper);
  EXPECT_EQ(result.frames.size(), static_cast<std::size_t>(DeskScene::kFrames - 1));
  ASSERT_EQ(result.skipped.size(), 1u);
  EXPECT_EQ(result.skipped[0].position, 3);
  EXPECT_EQ(result.skipped[0].fault, "pose is not finite");
}

TEST(RunSequence, StopsWhenAskedAndKeepsWhatItHas) {
  const DeskScene scene;
  Mapper mapper({});
  const SequenceResult result =
      run_sequence(scene, positions({}, scene.size()), mapper,
                   [](std::size_t done, std::size_t, const FrameReport*) { return done < 4; });
  EXPECT_EQ(result.frames.size(), 4u);
}

TEST(RunSequence, NamesTheFaultWhenNothingIsUsable) {
  DeskScene scene;
  scene.bad_frame = 5;
  Mapper mapper({});
  const std::string fault = error_of([&] { run_sequence(scene, {5}, mapper); });
  EXPECT_NE(fault.find("pose is not finite"), std::string::npos);
}

TEST(MakeDocument, HoldsTheMapAndItsInstances) {
  const DeskScene scene;
  Mapper mapper({}, std::make_shared<DeskMasks>());
  const SequenceResult result = run_sequence(scene, positions({}, scene.size()), mapper);
  const std::uint64_t hash = mapper.map().content_hash();
  const MapDocument document = make_document(std::move(mapper), result, {"desk", "a: 1\n"});
  EXPECT_EQ(document.content_hash, hash);
  EXPECT_EQ(document.map.content_hash(), hash);
  EXPECT_EQ(document.instances.size(), 3u);
  EXPECT_EQ(document.frames.size(), static_cast<std::size_t>(DeskScene::kFrames));
  EXPECT_EQ(document.mask_frames, DeskScene::kFrames);
  EXPECT_EQ(parse_timings(document.timings).at("integrate").count,
            static_cast<std::size_t>(DeskScene::kFrames));
}

}  // namespace
}  // namespace ovimap
