// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// Rooms of maps against the true ones of rendered floor plans.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>

#include "ovimap/image/codec.h"
#include "ovimap/pipeline/rooms/room_plan.h"
#include "ovimap/synth/buildings/benchmark_scenes.h"
#include "ovimap/synth/buildings/floor_plan.h"
#include "true_map_fixture.h"

namespace ovimap {
namespace {

struct RoomFigures {
  std::size_t true_rooms = 0, found = 0, doors = 0;
  double right = 0;  ///< share of the true floor whose room is the one that fits it best, each once
};

/// For those who look at it: $OVIMAP_ROOM_PICTURES is a folder.
void draw(const RoomPlan& plan, const std::string& name) {
  const char* folder = std::getenv("OVIMAP_ROOM_PICTURES");
  if (!folder) return;
  Image<std::uint8_t> picture(plan.floor.width(), plan.floor.height());
  for (std::size_t i = 0; i < picture.size(); ++i)
    picture[i] = static_cast<std::uint8_t>(plan.floor[i] == 0 ? 0 : 55 + plan.floor[i] * 61 % 200);
  write_file(std::filesystem::path(folder) / (name + ".png"), encode_png(picture));
}

RoomFigures compare(const SynthRoom& truth, const RoomPlan& plan) {
  RoomFigures figures{truth.zones.size(), plan.rooms.size(), plan.doors.size()};
  std::vector<std::vector<int>> shared(truth.zones.size(), std::vector<int>(plan.rooms.size() + 1));
  int cells = 0;
  for (std::size_t z = 0; z < truth.zones.size(); ++z) {
    const Eigen::AlignedBox2f& floor = truth.zones[z].floor_m;
    for (float y = floor.min().y() + 0.025f; y < floor.max().y(); y += 0.05f)
      for (float x = floor.min().x() + 0.025f; x < floor.max().x(); x += 0.05f, ++cells)
        ++shared[z][static_cast<std::size_t>(plan.room_at({x, y}))];
  }
  int right = 0;
  for (std::size_t n = 0; n < truth.zones.size(); ++n) {  // the best pair left, each once
    int most = 0;
    std::size_t zone = 0, room = 0;
    for (std::size_t z = 0; z < shared.size(); ++z)
      for (std::size_t r = 1; r < shared[z].size(); ++r)
        if (shared[z][r] > most) most = shared[z][r], zone = z, room = r;
    if (most == 0) break;
    right += most;
    std::fill(shared[zone].begin(), shared[zone].end(), 0);
    for (auto& of_zone : shared) of_zone[room] = 0;
  }
  figures.right = static_cast<double>(right) / cells;
  return figures;
}

RoomFigures measure(const std::string& name, const SynthRoom& room) {
  const Renderer renderer(room);
  const PinholeCamera camera{320, 240, 200.f, 200.f, 159.5f, 119.5f};
  const auto poses = fixture::walk_through(room, renderer.scene(), camera, 1.);
  const MapDocument map = fixture::true_map(room, renderer, camera, poses, 0.03f);
  const RoomPlan plan = find_rooms(make_occupancy_grid(map));
  draw(plan, name);
  const RoomFigures figures = compare(room, plan);
  std::printf("%s: %zu rooms, %zu found, %zu doors, %.1f %% of the floor in the right one\n",
              name.c_str(), figures.true_rooms, figures.found, figures.doors, 100 * figures.right);
  return figures;
}

class RoomsTruth : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::is_directory(default_furniture_folder()))
      GTEST_SKIP() << "the Debian package sweethome3d-furniture is not installed";
  }
};

TEST_F(RoomsTruth, AFlatWithACorridor) {
  const RoomFigures figures = measure("flat", build_plan(floor_plan("flat")));
  EXPECT_EQ(figures.found, figures.true_rooms);
  EXPECT_GE(figures.doors, figures.true_rooms - 1);
  EXPECT_GT(figures.right, 0.95);
}

TEST_F(RoomsTruth, UnseenFlats) {
  for (const char* name : {"harbour", "meadow"}) {
    const RoomFigures figures =
        measure(name, build_benchmark_scene(benchmark_scenes(name).at(0), 1));
    EXPECT_GT(figures.right, 0.9) << name;
  }
}

/// More of them, for the figures of docs/query.md; minutes.
TEST_F(RoomsTruth, DISABLED_ManyPlans) {
  for (const char* plan : {"flat", "loop"})
    for (const std::uint64_t seed : {1, 2, 3})
      measure(concat(plan, "-", seed), build_plan(floor_plan(plan, seed)));
  for (const char* name : {"courtyard", "harbour", "meadow"})
    for (const std::uint64_t seed : {1, 2, 3})
      measure(concat(name, "-", seed), build_benchmark_scene(benchmark_scenes(name).at(0), seed));
}

}  // namespace
}  // namespace ovimap
