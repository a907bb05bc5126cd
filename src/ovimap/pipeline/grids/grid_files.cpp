// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/grids/grid_files.h"

#include <cmath>
#include <cstdio>

#include <yaml-cpp/yaml.h>

#include "ovimap/image/codec.h"

namespace ovimap {

namespace {

constexpr float kMillimetre = 0.001f;
constexpr int kMostMillimetres = 65535;

Image<std::uint16_t> in_millimetres(const Image<float>& distance_m) {
  Image<std::uint16_t> result(distance_m.width(), distance_m.height());
  for (std::size_t i = 0; i < result.size(); ++i) {
    const float value = distance_m[i] / kMillimetre;
    result[i] = static_cast<std::uint16_t>(
        value < static_cast<float>(kMostMillimetres) ? std::lround(value) : kMostMillimetres);
  }
  return result;
}

std::string grid_yaml(const OccupancyGrid& grid, const GridSlice& slice, const std::string& image,
                      const std::string& esdf) {
  YAML::Emitter yaml;
  yaml.SetFloatPrecision(7);
  yaml.SetDoublePrecision(6);
  const auto pair = [&](const char* key, const auto& value) {
    yaml << YAML::Key << key << YAML::Value << value;
  };
  yaml << YAML::BeginMap;
  pair("image", image);
  pair("mode", "trinary");
  pair("resolution", slice.cell_m);
  yaml << YAML::Key << "origin" << YAML::Value << YAML::Flow
       << std::vector<float>{slice.origin.x(), slice.origin.y(), 0.f};
  pair("negate", 0);
  pair("occupied_thresh", 0.65);
  pair("free_thresh", 0.196);
  yaml << YAML::Key << "esdf" << YAML::Value << YAML::BeginMap;
  pair("image", esdf);
  pair("metres_per_unit", kMillimetre);
  pair("no_obstacle", kMostMillimetres);
  yaml << YAML::EndMap;
  yaml << YAML::Key << "heights_above_floor_m" << YAML::Value << YAML::Flow
       << std::vector<float>{slice.low_m, slice.high_m};
  pair("floor_m", grid.floor_m);
  std::vector<float> rows;
  for (int i = 0; i < 9; ++i) rows.push_back(grid.grid_from_world(i / 3, i % 3));
  yaml << YAML::Key << "grid_from_world" << YAML::Value << YAML::Flow << rows;
  yaml << YAML::EndMap;
  return std::string(yaml.c_str()) + "\n";
}

}  // namespace

void write_grid_slice(const std::filesystem::path& path, const OccupancyGrid& grid,
                      const GridSlice& slice) {
  const std::string stem = path.stem().string();
  const std::string image = stem + "_grid.png", esdf = stem + "_esdf.png";
  write_file(path.parent_path() / image, encode_png(slice.occupancy));
  write_file(path.parent_path() / esdf, encode_png(in_millimetres(slice.distance_m)));
  const std::string yaml = grid_yaml(grid, slice, image, esdf);
  write_text(path, yaml);
}

std::filesystem::path layer_path(const std::filesystem::path& path, float height_m) {
  char suffix[48];
  std::snprintf(suffix, sizeof suffix, "_%.2fm", double{height_m});
  return path.parent_path() / (path.stem().string() + suffix + path.extension().string());
}

}  // namespace ovimap
