// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/grids/occupancy_grid.h"

#include <cmath>

#include <gtest/gtest.h>

#include "ovimap/pipeline/mapping/desk_fixture.h"
#include "ovimap/pipeline/sequence/sequence_run.h"

namespace ovimap {
namespace {

/// The table top at z = 0 is the floor here; the balls reach up to 0.2 and 0.24 m.
class OccupancyGridTest : public ::testing::Test {
 protected:
  OccupancyGridTest() {
    const DeskScene scene;
    MapperConfig config;
    Mapper mapper(config, std::make_shared<DeskMasks>());
    std::vector<std::int64_t> all(DeskScene::kFrames);
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::int64_t>(i);
    const SequenceResult result = run_sequence(scene, all, mapper);
    document_ = make_document(std::move(mapper), result, {"desk"});
    document_.up = Eigen::Vector3f::UnitZ();
  }

  static std::uint8_t level(const GridSlice& slice, float x, float y) {
    const auto column = static_cast<int>((x - slice.origin.x()) / slice.cell_m),
               row = static_cast<int>((y - slice.origin.y()) / slice.cell_m);
    return slice.occupancy.at(column, slice.occupancy.height() - 1 - row);
  }
  static float distance(const GridSlice& slice, float x, float y) {
    const auto column = static_cast<int>((x - slice.origin.x()) / slice.cell_m),
               row = static_cast<int>((y - slice.origin.y()) / slice.cell_m);
    return slice.distance_m.at(column, slice.occupancy.height() - 1 - row);
  }

  MapDocument document_;
  OccupancyConfig config_;
};

TEST_F(OccupancyGridTest, ObstaclesStandInTheWayAndTheRestIsFree) {
  config_.cell_m = 0.02f;
  const OccupancyGrid grid = make_occupancy_grid(document_, config_);
  EXPECT_NEAR(grid.floor_m, 0.f, 0.02f);
  EXPECT_TRUE(grid.grid_from_world.isIdentity());
  const GridSlice band = band_of(grid, 0.05f, 0.2f, config_);
  EXPECT_EQ(level(band, 0.24f, 0.f), 0);    // the red ball's side
  EXPECT_EQ(level(band, -0.2f, 0.21f), 0);  // the blue one's
  EXPECT_EQ(level(band, 0.f, -0.3f), 254);  // the table beside them
  EXPECT_EQ(level(band, 0.3f, 0.4f), 254);
  // The nearest side of the red ball (radius 0.1 at 0.15, 0) from (0, -0.3).
  EXPECT_NEAR(distance(band, 0.f, -0.3f), std::hypot(0.15f, 0.3f) - 0.1f, 0.03f);
}

TEST_F(OccupancyGridTest, LayersKnowTheFloorBelow) {
  config_.cell_m = 0.02f;
  const OccupancyGrid grid = make_occupancy_grid(document_, config_);
  const auto layers = layers_of(grid, {0.1f, 0.22f});
  ASSERT_EQ(layers.size(), 2u);
  EXPECT_NEAR(distance(layers[0], 0.f, -0.35f), 0.1f, 0.03f);  // straight down
  EXPECT_EQ(level(layers[0], 0.25f, 0.f), 0);
  EXPECT_NE(level(layers[1], 0.25f, 0.f), 0);  // above the red ball's side
  EXPECT_THROW(layers_of(grid, {7.f}), Error);
}

TEST_F(OccupancyGridTest, TheWorldMayLieOnItsSide) {
  config_.cell_m = 0.02f;
  const GridSlice upright = band_of(make_occupancy_grid(document_, config_), 0.05f, 0.2f, config_);
  document_.up = Eigen::Vector3f::UnitX();  // now the table is a wall
  const OccupancyGrid wall = make_occupancy_grid(document_, config_);
  EXPECT_GT(wall.size.z(), 40);
  EXPECT_NE(band_of(wall, 0.05f, 0.2f, config_).occupancy, upright.occupancy);
}

TEST_F(OccupancyGridTest, RefusesWhatCannotBe) {
  config_.cell_m = 0.001f;
  EXPECT_THROW(make_occupancy_grid(document_, config_), Error);
  EXPECT_THROW(make_occupancy_grid(MapDocument()), Error);
  config_.cell_m = 0.1f;
  EXPECT_THROW(band_of(make_occupancy_grid(document_, config_), 0.2f, 0.05f, config_), Error);
}

}  // namespace
}  // namespace ovimap
