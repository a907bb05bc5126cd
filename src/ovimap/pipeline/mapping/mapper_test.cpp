// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/mapping/mapper.h"

#include <map>
#include <set>

#include <gtest/gtest.h>

#include "ovimap/base/parallel.h"
#include "ovimap/pipeline/mapping/desk_fixture.h"
#include "ovimap/pipeline/mapping/furnished_fixture.h"

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

/// Six boxes in a row of places, each with a colour of its own.
FurnishedRoom room_with_boxes() {
  FurnishedRoom room;
  room.frames = 60;
  for (int i = 0; i < 6; ++i)
    room.things.push_back(furniture(-1.f + 1.f * static_cast<float>(i % 3), i < 3 ? -0.5f : 0.5f,
                                    {0.4f, 0.4f, 0.5f},
                                    {static_cast<std::uint8_t>(40 * i), 200, 30}));
  return room;
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

TEST(Mapper, MasksOfAnotherSizeAreAFaultOfTheirFrame) {
  class SmallMasks : public MaskSource {
   public:
    std::string kind() const override { return "small"; }
    std::optional<Entities> entities(const Frame&, std::span<const MaskPrompt>) override {
      return Entities{IdImage(8, 6, 1), {1.f}};
    }
  };
  Mapper mapper({}, std::make_shared<SmallMasks>());
  try {
    mapper.process(*DeskScene().read(0).frame);
    FAIL();
  } catch (const FrameError& fault) {
    EXPECT_NE(std::string(fault.what())
                  .find("'small' masks of frame 0 are 8x6, but its colour image is 160x120"),
              std::string::npos)
        << fault.what();
  }
}

TEST(Mapper, MasksOfNoiseAreAFaultOfTheirFrame) {
  class NoisyMasks : public MaskSource {
   public:
    std::string kind() const override { return "noisy"; }
    std::optional<Entities> entities(const Frame& frame, std::span<const MaskPrompt>) override {
      Entities noise{IdImage(frame.color.width(), frame.color.height()), {}};
      for (std::uint16_t& id : noise.ids) noise.scores.push_back(1.f), id = noise.scores.size();
      return noise;
    }
  };
  Mapper mapper({}, std::make_shared<NoisyMasks>());
  try {
    mapper.process(*DeskScene().read(0).frame);
    FAIL();
  } catch (const FrameError& fault) {
    EXPECT_NE(std::string(fault.what()).find("name 19200 things; more than 2000 in one image"),
              std::string::npos)
        << fault.what();
  }
}

TEST(Mapper, MasksThatTellNothingAreCounted) {
  class BlankMasks : public MaskSource {
   public:
    std::string kind() const override { return "blank"; }
    std::optional<Entities> entities(const Frame& frame, std::span<const MaskPrompt>) override {
      Entities blank{IdImage(frame.color.width(), frame.color.height()), {}};
      if (frame.index == 0) return blank;  // nothing, then everything, then half of it
      const auto shown = blank.ids.begin() +
                         static_cast<std::ptrdiff_t>(blank.ids.size() / (frame.index == 1 ? 1 : 2));
      std::fill(blank.ids.begin(), shown, std::uint16_t{1});
      blank.scores = {1.f};
      return blank;
    }
  };
  Mapper mapper({}, std::make_shared<BlankMasks>());
  const DeskScene desk;
  for (int i = 0; i < 4; ++i) mapper.process(*desk.read(i).frame);
  EXPECT_EQ(mapper.mask_frames(), 4);
  EXPECT_EQ(mapper.masks_seen().frames, 4);
  EXPECT_EQ(mapper.masks_seen().blank, 2);
}

TEST(Mapper, AFrameThatSeesThroughTheMapIsAFaultOfItsOwn) {
  const FurnishedRoom room = room_with_boxes();
  Mapper mapper(furnished_config(), std::make_shared<FurnishedMasks>(room));
  for (int i = 0; i < 8; ++i) mapper.process(*room.read(i).frame);
  const std::uint64_t before = mapper.map().content_hash();
  Frame far = *room.read(8).frame;
  for (float& depth_m : far.depth) depth_m *= 3;
  try {
    mapper.process(far);
    FAIL() << "it was fused";
  } catch (const FrameError& fault) {
    EXPECT_NE(std::string(fault.what()).find("frame8: sees through"), std::string::npos)
        << fault.what();
  }
  EXPECT_EQ(mapper.map().content_hash(), before);
  EXPECT_EQ(mapper.frames(), 8);
  mapper.process(*room.read(8).frame);
}

TEST(Mapper, WhatAllFramesSeeThroughForAWhileWasWrong) {
  const FurnishedRoom room = room_with_boxes();
  Mapper mapper(furnished_config(), std::make_shared<FurnishedMasks>(room));
  Frame frame = *room.read(0).frame;
  for (float& depth_m : frame.depth) depth_m /= 3;  // a hand on the lens
  for (int i = 0; i < 4; ++i) mapper.process(frame);
  const auto taken_at = [&](double time_s) {
    frame = *room.read(0).frame;
    frame.timestamp_s = time_s;
    try {
      mapper.process(frame);
      return true;
    } catch (const FrameError&) {
      return false;
    }
  };
  for (const double time_s : {10., 10.5, 11.4}) EXPECT_FALSE(taken_at(time_s)) << time_s;
  EXPECT_TRUE(taken_at(11.5));
  int left_out = 0;
  while (left_out < 100 && !taken_at(11.5)) ++left_out;
  EXPECT_LT(left_out, 100) << "clocks that stand still count as a camera's usual pace";
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
  for (const std::int64_t masked_every : {1, 3}) {
    const auto hash = [&](int threads) {
      ThreadLimit limit(threads);
      auto masks = std::make_shared<DeskMasks>();
      masks->masked_every = masked_every;
      Mapper mapper({}, masks);
      map_desk(mapper);
      return mapper.map().content_hash();
    };
    const std::uint64_t once = hash(2);
    EXPECT_EQ(once, hash(2));
    EXPECT_EQ(once, hash(1));
  }
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

TEST(Mapper, AsksANetworkWhenThePictureHasMoved) {
  MapperConfig config;
  config.mask_motion = 0.4f;  // the desk's frames are 30 degrees apart
  config.allow_still_camera = true;
  Mapper mapper(config, std::make_shared<SlowDeskMasks>());
  const DeskScene scene;
  std::vector<std::int64_t> asked;
  for (const std::int64_t i : {0, 0, 1, 1, 2, 2, 3, 3, 4})
    if (mapper.process(*scene.read(i).frame).labelled) asked.push_back(i);
  EXPECT_EQ(asked.front(), 0);
  EXPECT_EQ(std::adjacent_find(asked.begin(), asked.end()), asked.end()) << "nothing had moved";
  EXPECT_GE(asked.size(), 2u);
  config.mask_motion = 0.f;
  Mapper every(config, std::make_shared<SlowDeskMasks>());
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(every.process(*scene.read(0).frame).labelled);
}

/// Of the boxes, those that are an object of their own.
std::size_t boxes_found(const FurnishedRoom& room, const Mapper& mapper) {
  MapRecord found;
  found.instances = summarize_instances(mapper.map(), mapper.registry(), {});
  std::set<InstanceId> objects;
  for (const Furniture& thing : room.things) {
    const Eigen::Vector3f center = thing.box.center();
    objects.insert(object_at(found, Pose::Identity(), center.x(), center.y(), center.z()));
  }
  return objects.size() - objects.count(0);
}

Mapper map_boxes(const FurnishedRoom& room, int masked_every, bool blind = false) {
  auto masks = std::make_shared<FurnishedMasks>(room);
  masks->masked_every = masked_every;
  masks->blind = blind;
  MapperConfig config;
  config.map.voxel_size_m = 0.02f;
  Mapper mapper(config, masks);
  for (std::int64_t i = 0; i < room.size(); ++i) mapper.process(*room.read(i).frame);
  return mapper;
}

TEST(Mapper, MasksOnSomeFramesAloneTellAllObjectsApart) {
  const FurnishedRoom room = room_with_boxes();
  struct Expected {
    int masked_every, mask_frames;
    std::size_t least_found;
  };
  for (const Expected& e :
       {Expected{1, 60, 6}, Expected{5, 12, 6}, Expected{11, 6, 5}, Expected{20, 3, 4}}) {
    const Mapper mapper = map_boxes(room, e.masked_every);
    EXPECT_GE(boxes_found(room, mapper), e.least_found) << "every " << e.masked_every;
    EXPECT_EQ(mapper.frames(), 60);
    EXPECT_EQ(mapper.mask_frames(), e.mask_frames);
  }
}

TEST(Mapper, MasksThatShowNothingCountAgainstObjectsAndMissingOnesDoNot) {
  const FurnishedRoom room = room_with_boxes();
  const Mapper unmasked = map_boxes(room, 60), masked = map_boxes(room, 1, true);
  EXPECT_EQ(unmasked.mask_frames(), 1);
  EXPECT_EQ(masked.mask_frames(), 60);
  const auto seen = [](const Mapper& mapper) {
    int most = 0;
    for (const auto& [label, point] : mapper.registry().super_points())
      most = std::max(most, point.frames_seen);
    return most;
  };
  EXPECT_EQ(seen(unmasked), 1);
  EXPECT_GT(seen(masked), 40);
  const auto objects = [](const Mapper& mapper) {
    return summarize_instances(mapper.map(), mapper.registry(), {.min_instance_views = 1}).size();
  };
  EXPECT_GE(objects(unmasked), 4u) << "what the only masks showed is all that is known";
  EXPECT_LT(objects(masked), objects(unmasked));
}

TEST(Mapper, AFrameWithoutMasksAddsGeometryAlone) {
  auto masks = std::make_shared<DeskMasks>();
  masks->masked_every = 2;
  Mapper mapper({}, masks);
  const DeskScene scene;
  EXPECT_TRUE(mapper.process(*scene.read(0).frame).labelled);
  const auto before = mapper.registry().state().super_points.size();
  const std::size_t blocks = mapper.map().block_count();
  const FrameReport report = mapper.process(*scene.read(1).frame);
  EXPECT_FALSE(report.labelled);
  EXPECT_EQ(report.segments, 0);
  EXPECT_GT(mapper.map().block_count(), blocks);
  EXPECT_EQ(mapper.registry().state().super_points.size(), before);
  EXPECT_EQ(mapper.frames(), 2);
  EXPECT_EQ(mapper.mask_frames(), 1);
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
