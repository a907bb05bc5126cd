// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/mapper.h"

#include <map>

#include <gtest/gtest.h>

#include "ovimap/base/parallel.h"
#include "ovimap/pipeline/desk_fixture.h"

namespace ovimap {
namespace {

void map_desk(Mapper& mapper) {
  const DeskScene scene;
  for (std::int64_t i = 0; i < scene.size(); ++i) mapper.process(*scene.read(i).frame);
}

/// Share of the pixels of a true id that show the instance most of them show, and that instance.
std::pair<double, InstanceId> purity(const IdImage& truth, const Image<InstanceId>& seen,
                                     std::uint16_t id) {
  std::map<InstanceId, int> counts;
  int total = 0;
  for (std::size_t i = 0; i < truth.size(); ++i)
    if (truth[i] == id) ++counts[seen[i]], ++total;
  const auto most = std::max_element(counts.begin(), counts.end(),
                                     [](auto& a, auto& b) { return a.second < b.second; });
  return {static_cast<double>(most->second) / total, most->first};
}

TEST(Mapper, FindsTheObjectsOfTheDesk) {
  Mapper mapper({}, std::make_shared<DeskMasks>());
  map_desk(mapper);
  const auto summaries = summarize_instances(mapper.map(), mapper.registry(), {});
  EXPECT_EQ(summaries.size(), 3u);
  const DeskScene scene;
  const InstanceView view = mapper.project(*scene.read(5).frame);
  std::map<InstanceId, int> owners;
  for (std::uint16_t id = 1; id <= 3; ++id) {
    const auto [share, instance] = purity(*scene.truth_ids(5), view.instances, id);
    EXPECT_GT(share, 0.9) << "object " << id;
    EXPECT_NE(instance, 0u);
    ++owners[instance];
  }
  EXPECT_EQ(owners.size(), 3u) << "each its own";
}

TEST(Mapper, DepthAloneSeparatesTheBallsFromTheTable) {
  Mapper mapper({});
  map_desk(mapper);
  const DeskScene scene;
  const InstanceView view = mapper.project(*scene.read(5).frame);
  std::map<InstanceId, int> owners;
  for (std::uint16_t id = 1; id <= 3; ++id)
    ++owners[purity(*scene.truth_ids(5), view.instances, id).second];
  EXPECT_EQ(owners.size(), 3u);
}

TEST(Mapper, GivesTheSameMapOnEveryRunAndThreadCount) {
  const auto hash = [](int threads) {
    ThreadLimit limit(threads);
    Mapper mapper({}, std::make_shared<DeskMasks>());
    map_desk(mapper);
    return mapper.map().content_hash();
  };
  const std::uint64_t once = hash(2);
  EXPECT_EQ(once, hash(2));
  EXPECT_EQ(once, hash(1));
}

TEST(Mapper, AFailingMaskSourceLeavesTheMapAsItWas) {
  auto masks = std::make_shared<DeskMasks>();
  masks->failing_frame = 2;
  Mapper mapper({}, masks);
  const DeskScene scene;
  mapper.process(*scene.read(0).frame);
  mapper.process(*scene.read(1).frame);
  const std::uint64_t before = mapper.map().content_hash();
  EXPECT_THROW(mapper.process(*scene.read(2).frame), Error);
  EXPECT_EQ(mapper.map().content_hash(), before);
  EXPECT_EQ(mapper.frames(), 2);
}

TEST(Mapper, AsksForMasksAtTheInterval) {
  MapperConfig config;
  config.mask_interval = 3;
  Mapper mapper(config, std::make_shared<DeskMasks>());
  const DeskScene scene;
  for (std::int64_t i = 0; i < 6; ++i)
    EXPECT_EQ(mapper.process(*scene.read(i).frame).labelled, i % 3 == 0);
  EXPECT_EQ(mapper.mask_frames(), 2);
}

TEST(Mapper, FrameOrderDoesNotMoveTheSurface) {
  const DeskScene scene;
  Mapper forward({}), backward({});
  for (std::int64_t i = 0; i < scene.size(); ++i) forward.process(*scene.read(i).frame);
  for (std::int64_t i = scene.size(); i-- > 0;) backward.process(*scene.read(i).frame);
  ASSERT_EQ(forward.map().block_count(), backward.map().block_count());
  for (std::uint32_t slot = 0; slot < forward.map().block_count(); ++slot) {
    const VoxelBlock& a = forward.map().block(slot);
    const VoxelBlock* b = backward.map().find(a.index);
    ASSERT_NE(b, nullptr);
    for (int v = 0; v < kBlockVoxels; ++v)
      ASSERT_NEAR(forward.map().distance_m(a, v), backward.map().distance_m(*b, v), 1e-4f);
  }
}

}  // namespace
}  // namespace ovimap
