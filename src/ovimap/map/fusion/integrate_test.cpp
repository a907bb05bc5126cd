// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/map/fusion/integrate.h"

#include <gtest/gtest.h>

#include "ovimap/base/parallel.h"
#include "ovimap/map/fusion/block_update.h"
#include "ovimap/map/fusion/plain_fusion.h"
#include "ovimap/map/rays/sphere_fixture.h"
#include "ovimap/map/rays/surface_lookup.h"
#include "ovimap/map/voxels/label_slots.h"

namespace ovimap {
namespace {

TEST(Integrate, DistancesMatchTheSphereAlongTheView) {
  const SphereScene scene;
  VoxelMap map;
  scene.integrate_views(map, 1, 7);
  int checked = 0;
  for (std::uint32_t slot = 0; slot < map.block_count(); ++slot) {
    const VoxelBlock& block = map.block(slot);
    for (int v = 0; v < kBlockVoxels; ++v) {
      if (block.weight[static_cast<std::size_t>(v)] <= 0.f) continue;
      const Eigen::Vector3i offset(v & 7, v >> 3 & 7, v >> 6);
      const Eigen::Vector3f center =
          ((block.index * 8 + offset).cast<float>().array() + 0.5f) * 0.01f;
      if (center.head<2>().norm() > 0.05f) continue;  // near the axis the ray is the normal
      EXPECT_NEAR(map.distance_m(block, v), center.norm() - SphereScene::kRadius, 0.004f);
      ++checked;
    }
  }
  EXPECT_GT(checked, 500);
}

TEST(Integrate, SurfaceVoxelsTakeColourAndLabel) {
  const SphereScene scene;
  VoxelMap map;
  const Label label = map.labels().create();
  scene.integrate_views(map, 4, label);
  int labelled = 0;
  for (std::uint32_t slot = 0; slot < map.block_count(); ++slot) {
    const VoxelBlock& block = map.block(slot);
    for (int v = 0; v < kBlockVoxels; ++v) {
      if (voxel_label(block, v, map.labels()) == kNoLabel) continue;
      ++labelled;
      EXPECT_EQ(color_levels(block.color[static_cast<std::size_t>(v)])[0], 200);
      EXPECT_LE(voxel_labels(block, v, map.labels())[0].support, 4u) << "one vote a frame";
    }
  }
  EXPECT_GT(labelled, 1000);
}

TEST(Integrate, WhoSeesAVoxelFromNearTellsMore) {
  const DepthImage depth(640, 480, 1.f);
  const PinholeCamera camera{640, 480, 500, 500, 320, 240};
  const Pose pose = Pose::Identity();
  const Observation observation{.depth = depth, .camera = camera, .world_from_camera = pose};
  VoxelMapConfig config;  // voxels of 1 cm
  const FusionView view(config, observation);
  EXPECT_EQ(view.votes(1.f), 5);
  EXPECT_EQ(view.votes(2.5f), 2);
  EXPECT_EQ(view.votes(20.f), 1);
  EXPECT_EQ(view.votes(1e-3f), 255);
  config.pixel_votes = false;
  EXPECT_EQ(FusionView(config, observation).votes(1.f), 1);
}

/// Distance along the axis from `near_m` on at which a map of a wall passes from front to back, for
/// every pass.
std::vector<float> passes(const VoxelMap& map, float near_m, float far_m) {
  std::vector<float> found;
  VoxelFinder finder(map);
  float last_m = 0;
  for (float z = near_m; z < far_m; z += map.config().voxel_size_m) {
    const bool seen = finder.seek(Eigen::Vector3f(0.f, 0.f, z)) && finder.observed();
    const float here_m = seen ? finder.distance_m() : 0.f;
    if (last_m > 0.f && here_m < 0.f) found.push_back(z);
    last_m = here_m;
  }
  return found;
}

TEST(Integrate, DepthThatErrsByMoreThanTheTruncationLeavesOneSurface) {
  const PinholeCamera camera{64, 48, 50, 50, 31.5f, 23.5f};
  const Pose pose = Pose::Identity();
  constexpr int kFrames = 40;
  const auto surfaces = [&](bool known) {
    VoxelMap map;  // truncation of 5 cm
    const Image<float> sigma(64, 48, 0.08f);
    for (int frame = 0; frame < kFrames; ++frame) {
      const float spread = 0.08f * 3.4641016f;  // uniform, of that deviation
      const DepthImage depth(
          64, 48,
          4.f + spread * (static_cast<float>(frame * 17 % kFrames) / (kFrames - 1.f) - 0.5f));
      integrate(map, {.depth = depth,
                      .camera = camera,
                      .world_from_camera = pose,
                      .sigma_m = known ? &sigma : nullptr});
    }
    return passes(map, 3.5f, 4.5f);
  };
  const std::vector<float> found = surfaces(true);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0], 4.f, 0.025f);
  const std::vector<float> unknown = surfaces(false);
  EXPECT_FALSE(unknown.size() == 1 && std::abs(unknown[0] - 4.f) < 0.025f)
      << "the case is too easy";
}

TEST(Integrate, LabelsReachAsFarAsTheSurfaceMayLie) {
  const PinholeCamera camera{64, 48, 50, 50, 31.5f, 23.5f};
  const DepthImage depth(64, 48, 2.f);
  const Image<float> sigma(64, 48, 0.03f);
  const IdImage segments(64, 48, 1);
  const Pose pose = Pose::Identity();
  VoxelMap map;
  const std::vector<Label> labels = {map.labels().create()};
  integrate(map, {.depth = depth,
                  .camera = camera,
                  .world_from_camera = pose,
                  .sigma_m = &sigma,
                  .segment_ids = &segments,
                  .segment_labels = labels});
  VoxelFinder finder(map);
  const auto label_at = [&](float z) {
    return finder.seek(Eigen::Vector3f(0.f, 0.f, z)) ? map.label(finder.ref()) : kNoLabel;
  };
  EXPECT_EQ(label_at(1.975f), labels[0]);
  EXPECT_EQ(label_at(2.025f), labels[0]);
  EXPECT_EQ(label_at(1.955f), kNoLabel);
  EXPECT_EQ(label_at(2.045f), kNoLabel);
}

TEST(Integrate, GivesTheSameBitsForEveryThreadCount) {
  const SphereScene scene;
  const auto hash = [&](int threads) {
    ThreadLimit limit(threads);
    VoxelMap map;
    scene.integrate_views(map, 5, map.labels().create());
    return map.content_hash();
  };
  EXPECT_EQ(hash(1), hash(2));
}

/// A frame with everything that makes fusion branch: noise, holes, unknown planes and colours, and
/// segments of which one has no label.
struct RoughFrame {
  DepthImage depth;
  Image<float> slope, sigma;
  RgbImage color;
  IdImage segments;

  RoughFrame(const SphereScene& scene, std::uint32_t seed)
      : depth(scene.depth()),
        slope(scene.plane_slope()),
        sigma(depth.width(), depth.height()),
        color(depth.width(), depth.height()),
        segments(depth.width(), depth.height()) {
    for (std::size_t i = 0; i < depth.size(); ++i) {
      seed = seed * 1664525u + 1013904223u;
      depth[i] += depth[i] > 0.f ? 0.01f * (static_cast<float>(seed >> 8) / 16777216.f - 0.5f) : 0;
      if (seed >> 28 == 0) depth[i] = 0.f;
      if (seed >> 28 == 1) slope[i] = 0.f;
      sigma[i] = 0.2f * static_cast<float>(seed >> 20 & 255) / 256.f;
      if (seed >> 28 > 2)
        color[i] = {static_cast<std::uint8_t>(seed >> 20), static_cast<std::uint8_t>(seed >> 12),
                    static_cast<std::uint8_t>(seed >> 4)};
      segments[i] = static_cast<std::uint16_t>(i / 37 % 4);
    }
  }
};

TEST(Integrate, EqualsThePlainFusionToTheBit) {
  const SphereScene scene;
  VoxelMap fast, plain;
  std::vector<Label> labels;
  for (VoxelMap* map : {&fast, &plain})
    labels = {map->labels().create(), kNoLabel, map->labels().create()};
  for (int view = 0; view < 5; ++view) {
    const RoughFrame frame(scene, 7u + static_cast<std::uint32_t>(view));
    const Pose pose = scene.pose(0.4 * view);
    const Observation observation{.depth = frame.depth,
                                  .camera = scene.camera,
                                  .world_from_camera = pose,
                                  .color = view == 2 ? nullptr : &frame.color,
                                  .plane_slope = view == 3 ? nullptr : &frame.slope,
                                  .sigma_m = view == 0 ? nullptr : &frame.sigma,
                                  .segment_ids = view == 1 ? nullptr : &frame.segments,
                                  .segment_labels = labels};
    integrate(fast, observation);
    plain::integrate(plain, observation);
    ASSERT_EQ(fast.content_hash(), plain.content_hash()) << "view " << view;
    for (std::uint32_t slot = 0; slot < fast.block_count(); ++slot)
      ASSERT_EQ(fast.block(slot).observed_rows, plain.find(fast.block_index(slot))->observed_rows);
  }
  EXPECT_GT(fast.block_count(), 100u);
}

TEST(VoteLabels, GivesTheVotesThatIntegrateWouldHaveGiven) {
  const SphereScene scene;
  VoxelMap together, apart;
  std::vector<Label> labels;
  for (VoxelMap* map : {&together, &apart})
    labels = {map->labels().create(), kNoLabel, map->labels().create()};
  for (int view = 0; view < 3; ++view) {
    const RoughFrame frame(scene, 50u + static_cast<std::uint32_t>(view));
    const Pose pose = scene.pose(0.4 * view);
    Observation observation{.depth = frame.depth,
                            .camera = scene.camera,
                            .world_from_camera = pose,
                            .color = &frame.color,
                            .plane_slope = &frame.slope,
                            .segment_ids = &frame.segments,
                            .segment_labels = labels};
    integrate(together, observation);
    observation.segment_ids = nullptr;
    integrate(apart, observation);
    EXPECT_NE(apart.content_hash(), together.content_hash());
    observation.segment_ids = &frame.segments;
    vote_labels(apart, observation);
    EXPECT_EQ(apart.content_hash(), together.content_hash());
  }
}

TEST(Integrate, IgnoresInvalidDepth) {
  VoxelMap map;
  const PinholeCamera camera{8, 8, 8.f, 8.f, 3.5f, 3.5f};
  const Pose pose = Pose::Identity();
  EXPECT_TRUE(
      integrate(map, {.depth = DepthImage(8, 8), .camera = camera, .world_from_camera = pose})
          .empty());
  EXPECT_EQ(map.block_count(), 0u);
}

TEST(AllocateBlocks, RefusesBlocksThatWouldHaveTheKeysOfOthers) {
  const PinholeCamera camera{8, 6, 8.f, 8.f, 3.5f, 2.5f};
  const DepthImage depth(8, 6, 1.f);
  VoxelMapConfig config;
  config.voxel_size_m = 0.001f;
  VoxelMap map(config);
  Pose pose = Pose::Identity();
  pose.translation().y() = -7900;
  const Observation observation{.depth = depth, .camera = camera, .world_from_camera = pose};
  for (const std::uint32_t slot : allocate_blocks(map, observation))
    EXPECT_LT(map.block_index(slot).y(), 0);
  pose.translation().y() = -9000;  // of poses up to 10 km are taken
  try {
    allocate_blocks(map, observation);
    FAIL();
  } catch (const Error& fault) {
    EXPECT_NE(std::string(fault.what()).find("9000 m from the origin"), std::string::npos);
  }
}

TEST(AllocateBlocks, LeavesTheMapAsItWasWhereMemoryHasNoRoom) {
  const PinholeCamera camera{64, 48, 50, 50, 31.5f, 23.5f};
  const DepthImage near(64, 48, 1.f), far(64, 48, 8.f);
  const Pose pose = Pose::Identity();
  VoxelMap map;
  const std::size_t blocks =
      allocate_blocks(map, {.depth = near, .camera = camera, .world_from_camera = pose}).size();
  map.set_room(2 * blocks * VoxelBlock::kMostBytes);
  const Observation large{.depth = far, .camera = camera, .world_from_camera = pose};
  EXPECT_THROW(allocate_blocks(map, large), FrameError);
  EXPECT_EQ(map.block_count(), blocks);
  map.set_room(std::size_t{1} << 40);
  EXPECT_GT(allocate_blocks(map, large).size(), 2 * blocks);
}

TEST(AllocateBlocks, CreatesNoneBeyondTheTruncationButReturnsThoseThatAreThere) {
  const PinholeCamera camera{64, 48, 50, 50, 31.5f, 23.5f};
  const DepthImage near(64, 48, 2.f), far(64, 48, 2.3f);
  const Image<float> sigma(64, 48, 0.15f);
  const Pose pose = Pose::Identity();
  VoxelMap map;
  const std::size_t created =
      allocate_blocks(map, {.depth = near, .camera = camera, .world_from_camera = pose}).size();
  const Observation behind{
      .depth = far, .camera = camera, .world_from_camera = pose, .sigma_m = &sigma};
  const std::size_t returned = allocate_blocks(map, behind).size();
  EXPECT_EQ(returned, map.block_count());
  EXPECT_GT(returned, map.block_count() - created);
  VoxelMap alone;
  EXPECT_EQ(allocate_blocks(alone, behind).size(), map.block_count() - created);
}

TEST(AllocateBlocks, CoversTheBandOfEveryPixel) {
  const SphereScene scene;
  VoxelMap map;
  const DepthImage depth = scene.depth();
  const Pose pose = scene.pose(0.3);
  allocate_blocks(map, {.depth = depth, .camera = scene.camera, .world_from_camera = pose});
  int points = 0, covered = 0;
  for (int y = 0; y < depth.height(); ++y)
    for (int x = 0; x < depth.width(); ++x) {
      if (depth.at(x, y) <= 0.f) continue;
      const Eigen::Vector3f point =
          pose.cast<float>() *
          scene.camera.unproject(static_cast<float>(x), static_cast<float>(y), depth.at(x, y));
      ++points;
      covered += map.find(block_at(point, 1.f / map.config().block_size_m())) != nullptr;
    }
  EXPECT_GT(covered, points * 995 / 1000)
      << "only corners cut by less than the sampling pitch may be missing";
}

}  // namespace
}  // namespace ovimap
