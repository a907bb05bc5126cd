// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/grids/grid_files.h"

#include <limits>

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "ovimap/base/temporary_folder_fixture.h"

namespace ovimap {
namespace {

TEST(GridFiles, SayWhatMapServerAsks) {
  const fixture::TemporaryFolder folder;
  OccupancyGrid grid;
  grid.floor_m = -1.5f;
  GridSlice slice;
  slice.occupancy = Image<std::uint8_t>(3, 2, 254);
  slice.occupancy.at(0, 1) = 0;
  slice.distance_m = Image<float>(3, 2, 0.25f);
  slice.distance_m.at(1, 0) = std::numeric_limits<float>::infinity();
  slice.distance_m.at(2, 0) = 100.f;
  slice.cell_m = 0.05f;
  slice.origin = {-2.15f, 3.f};
  slice.high_m = 1.5f;
  const auto path = folder.path() / "my: room #1.yaml";
  write_grid_slice(path, grid, slice);
  const YAML::Node yaml = YAML::LoadFile(path.string());
  EXPECT_EQ(yaml["resolution"].as<float>(), 0.05f);
  EXPECT_EQ(yaml["origin"].as<std::vector<float>>(), (std::vector<float>{-2.15f, 3.f, 0.f}));
  EXPECT_EQ(yaml["negate"].as<int>(), 0);
  EXPECT_EQ(yaml["floor_m"].as<float>(), -1.5f);
  EXPECT_EQ(yaml["grid_from_world"].size(), 9u);
  const GrayPng picture = read_gray(folder.path() / yaml["image"].as<std::string>());
  EXPECT_EQ(picture.bits, 8);
  EXPECT_EQ(picture.values.at(0, 1), 0);
  EXPECT_EQ(picture.values.at(0, 0), 254);
  const GrayPng esdf = read_gray(folder.path() / yaml["esdf"]["image"].as<std::string>());
  EXPECT_EQ(esdf.bits, 16);
  EXPECT_EQ(esdf.values.at(0, 0), 250);
  EXPECT_EQ(esdf.values.at(1, 0), 65535);
  EXPECT_EQ(esdf.values.at(2, 0), 65535);
  EXPECT_EQ(layer_path("a/b.yaml", 0.5f), std::filesystem::path("a/b_0.50m.yaml"));
}

}  // namespace
}  // namespace ovimap
