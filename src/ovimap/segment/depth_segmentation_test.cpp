// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/segment/depth_segmentation.h"

#include <random>

#include <gtest/gtest.h>

#include "ovimap/base/parallel.h"
#include "ovimap/segment/connected_regions.h"
#include "ovimap/segment/plain_segmentation.h"

namespace ovimap {
namespace {

const PinholeCamera kQvgaCamera{320, 240, 290.f, 290.f, 159.5f, 119.5f};

/// A table top seen at an angle with a box standing on it: nearest of three analytic surfaces.
struct TableScene {
  DepthImage depth{kQvgaCamera.width, kQvgaCamera.height};
  IdImage truth{kQvgaCamera.width,
                kQvgaCamera.height};  // 1 table, 2 top of the box, 3 front of the box
  explicit TableScene(float noise = 0.f, unsigned seed = 1) {
    std::mt19937 random(seed);
    std::normal_distribution<float> gauss(0.f, 1.f);
    const DepthNoiseConfig model;
    for (int y = 0; y < depth.height(); ++y)
      for (int x = 0; x < depth.width(); ++x) {
        set(x, y);
        if (depth.at(x, y) > 0.f)
          depth.at(x, y) += noise * model.sigma_m(depth.at(x, y)) * gauss(random);
      }
  }

 private:
  /// World: table at height 0, camera 0.8 m above looking 45 degrees down along +y.
  void set(int x, int y) {
    const Eigen::Vector3f ray =
        kQvgaCamera.unproject(static_cast<float>(x), static_cast<float>(y), 1.f);
    const float c = std::sqrt(0.5f);
    const Eigen::Vector3f d(ray.x(), c * ray.z() - c * ray.y(), -c * ray.z() - c * ray.y());
    const Eigen::Vector3f eye(0.f, 0.f, 0.8f);
    float best = 1e9f;
    const auto hit = [&](float t, std::uint16_t id, bool inside) {
      if (t > 0.f && t < best && inside) best = t, depth.at(x, y) = t, truth.at(x, y) = id;
    };
    if (d.z() < -1e-6f) {
      const float table = -eye.z() / d.z(), top = (0.2f - eye.z()) / d.z();
      hit(table, 1, true);
      const Eigen::Vector3f p = eye + top * d;
      hit(top, 2, std::abs(p.x()) < 0.15f && p.y() > 0.7f && p.y() < 1.0f);
    }
    if (d.y() > 1e-6f) {
      const float front = 0.7f / d.y();
      const Eigen::Vector3f p = eye + front * d;
      hit(front, 3, std::abs(p.x()) < 0.15f && p.z() > 0.f && p.z() < 0.2f);
    }
  }
};

std::uint16_t majority(const DepthRegions& regions, const IdImage& truth, std::uint16_t id) {
  std::map<std::uint16_t, int> counts;
  for (std::size_t i = 0; i < truth.size(); ++i)
    if (truth[i] == id) ++counts[regions.ids[i]];
  return std::max_element(counts.begin(), counts.end(),
                          [](auto& a, auto& b) { return a.second < b.second; })
      ->first;
}

double share(const DepthRegions& regions, const IdImage& truth, std::uint16_t id,
             std::uint16_t region) {
  double of_id = 0, both = 0;
  for (std::size_t i = 0; i < truth.size(); ++i)
    if (truth[i] == id) of_id += 1, both += regions.ids[i] == region;
  return both / of_id;
}

TEST(SegmentDepth, SeparatesABoxFromItsTableAndKeepsTheBoxWhole) {
  for (const float noise : {0.f, 1.f}) {
    const TableScene scene(noise);
    const DepthRegions regions = segment_depth(scene.depth, kQvgaCamera, {});
    const std::uint16_t table = majority(regions, scene.truth, 1),
                        top = majority(regions, scene.truth, 2);
    const std::uint16_t front = majority(regions, scene.truth, 3);
    EXPECT_NE(table, 0);
    EXPECT_NE(top, table);
    EXPECT_EQ(top, front) << "the fold between top and front is convex";
    EXPECT_GT(share(regions, scene.truth, 1, table), 0.95) << "noise " << noise;
    EXPECT_GT(share(regions, scene.truth, 2, top), 0.9) << "noise " << noise;
  }
}

TEST(SegmentDepth, TheReferencePresetKeepsAQuantisedPlaneWhole) {
  TableScene scene;
  for (float& depth : scene.depth) depth = std::round(depth * 1000.f) / 1000.f;
  const DepthRegions regions =
      segment_depth(scene.depth, kQvgaCamera, reference_segment_depth_config());
  const std::uint16_t table = majority(regions, scene.truth, 1);
  EXPECT_NE(table, 0);
  EXPECT_GT(share(regions, scene.truth, 1, table), 0.8);
  EXPECT_NE(majority(regions, scene.truth, 2), table);
}

TEST(SegmentDepth, SameBitsForOneAndTwoThreads) {
  const TableScene scene(1.f, 3);
  const auto run = [&](int threads) {
    ThreadLimit limit(threads);
    return segment_depth(scene.depth, kQvgaCamera, {}).ids;
  };
  EXPECT_EQ(run(1), run(2));
}

TEST(SegmentDepth, DescribesItsRegions) {
  const TableScene scene;
  const DepthRegions regions = segment_depth(scene.depth, kQvgaCamera, {});
  std::vector<int> area(regions.regions.size() + 1, 0);
  for (std::uint16_t id : regions.ids) ++area[id];
  const std::vector<Eigen::Vector2i> deepest = deepest_pixels(regions);
  ASSERT_EQ(deepest.size(), regions.regions.size());
  for (std::size_t i = 0; i < regions.regions.size(); ++i) {
    const DepthRegion& region = regions.regions[i];
    EXPECT_EQ(region.area_px, area[i + 1]);
    EXPECT_EQ(regions.ids.at(deepest[i].x(), deepest[i].y()), i + 1);
    EXPECT_TRUE(region.extent_px.contains(deepest[i]));
  }
}

TEST(SegmentDepth, EqualsThePlainSegmentation) {
  std::size_t regions_compared = 0;
  for (const float noise : {0.f, 1.f, 3.f}) {
    TableScene scene(noise, 5);
    std::mt19937 random(11);
    for (float& depth : scene.depth)
      if (random() % 200 == 0) depth = 0.f;
    for (const SegmentDepthConfig& config :
         {SegmentDepthConfig{}, reference_segment_depth_config()}) {
      const DepthSurface surface = fit_depth_surface(scene.depth, kQvgaCamera, config.surface);
      const DepthRegions regions = segment_depth(surface, kQvgaCamera, config);
      EXPECT_EQ(regions.ids, plain::segment(surface, kQvgaCamera, config)) << "noise " << noise;
      regions_compared += regions.regions.size();
    }
  }
  EXPECT_GT(regions_compared, 10u);
}

TEST(SegmentDepth, EmptyDepthHasNoRegions) {
  EXPECT_TRUE(segment_depth(DepthImage(64, 48), kQvgaCamera, {}).regions.empty());
  EXPECT_TRUE(segment_depth(DepthImage(1, 1, 1.f), kQvgaCamera, {}).regions.empty());
}

TEST(ConnectedRegions, MatchesFloodFillOnRandomMasks) {
  std::mt19937 random(11);
  for (int round = 0; round < 20; ++round) {
    Image<std::uint8_t> mask(37, 29);
    for (auto& pixel : mask) pixel = random() % 100 < 58;
    const Image<std::uint32_t> ids = connected_regions(mask);
    Image<std::uint32_t> expected(37, 29);
    std::uint32_t next = 0;
    for (int y = 0; y < 29; ++y)
      for (int x = 0; x < 37; ++x) {
        if (!mask.at(x, y) || expected.at(x, y)) continue;
        std::vector<Eigen::Vector2i> open{{x, y}};
        expected.at(x, y) = ++next;
        while (!open.empty()) {
          const Eigen::Vector2i p = open.back();
          open.pop_back();
          for (const Eigen::Vector2i& d : {Eigen::Vector2i(1, 0), Eigen::Vector2i(-1, 0),
                                           Eigen::Vector2i(0, 1), Eigen::Vector2i(0, -1)}) {
            const Eigen::Vector2i q = p + d;
            if (!mask.contains(q.x(), q.y()) || !mask.at(q.x(), q.y()) || expected.at(q.x(), q.y()))
              continue;
            expected.at(q.x(), q.y()) = next;
            open.push_back(q);
          }
        }
      }
    ASSERT_EQ(ids, expected);
  }
}

}  // namespace
}  // namespace ovimap
