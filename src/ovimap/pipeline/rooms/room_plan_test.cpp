// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/rooms/room_plan.h"

#include <gtest/gtest.h>

namespace ovimap {
namespace {

constexpr float kPlanCell_m = 0.1f;

/// Two rooms of 3 x 3 m side by side with a wall of 0.2 m between them, 2.5 m high, cells of 0.1 m;
/// the corner of the first lies at (0, 0).
class TwoRooms {
 public:
  TwoRooms() {
    grid.cell_m = kPlanCell_m;
    grid.size = {64, 32, 26};
    grid.origin = {-kPlanCell_m, -kPlanCell_m, 0.f};
    grid.cells.assign(64 * 32 * 26, CellState::kUnknown);
    fill({0.f, 0.f, 0.f}, {6.2f, 3.f, 2.5f}, CellState::kFree);
    fill({0.f, 0.f, 2.5f}, {6.2f, 3.f, 2.6f}, CellState::kOccupied);  // ceiling
    fill({3.f, 0.f, 0.f}, {3.2f, 3.f, 2.5f}, CellState::kOccupied);
  }
  void fill(const Eigen::Vector3f& low, const Eigen::Vector3f& high, CellState state) {
    const auto cell = [&](const Eigen::Vector3f& point) {
      return ((point - grid.origin) / kPlanCell_m).array().round().cast<int>().eval();
    };
    const auto first = cell(low), last = cell(high);
    for (int z = first.z(); z < last.z(); ++z)
      for (int y = first.y(); y < last.y(); ++y)
        for (int x = first.x(); x < last.x(); ++x)
          grid.cells[static_cast<std::size_t>(x + grid.size.x() * (y + grid.size.y() * z))] = state;
  }
  /// An opening in the wall, up to `top_m`.
  void open(float from_m, float to_m, float top_m) {
    fill({3.f, from_m, 0.f}, {3.2f, to_m, top_m}, CellState::kFree);
  }

  OccupancyGrid grid;
};

TEST(RoomPlan, ADoorPartsRooms) {
  TwoRooms place;
  place.open(1.f, 1.8f, 2.5f);  // up to the ceiling: it is narrow, no more
  const RoomPlan plan = find_rooms(place.grid);
  ASSERT_EQ(plan.rooms.size(), 2u);
  EXPECT_NE(plan.room_at({1.f, 1.f}), plan.room_at({5.f, 1.f}));
  EXPECT_EQ(plan.room_at({1.f, 1.f}), plan.room_at({0.2f, 2.8f}));
  EXPECT_EQ(plan.room_at({-3.f, 1.f}), 0);
  for (const Room& room : plan.rooms) EXPECT_NEAR(room.area_m2, 9.f, 0.3f);
  ASSERT_EQ(plan.doors.size(), 1u);
  EXPECT_NEAR(plan.doors[0].place_m.x(), 3.1f, 0.2f);
  EXPECT_NEAR(plan.doors[0].place_m.y(), 1.4f, 0.2f);
  EXPECT_NEAR(plan.doors[0].width_m, 0.8f, 0.21f);
}

TEST(RoomPlan, ALintelPartsRoomsAboveAWideOpening) {
  TwoRooms place;
  place.open(0.5f, 2.5f, 2.f);
  const RoomPlan plan = find_rooms(place.grid);
  EXPECT_EQ(plan.rooms.size(), 2u);
  ASSERT_EQ(plan.doors.size(), 1u);
  EXPECT_NEAR(plan.doors[0].width_m, 2.f, 0.3f);
}

TEST(RoomPlan, AWideOpeningWithoutLintelIsNoDoor) {
  TwoRooms place;
  place.open(0.5f, 2.5f, 2.5f);
  EXPECT_EQ(find_rooms(place.grid).rooms.size(), 1u);
}

TEST(RoomPlan, LampsAndTablesPartNothing) {
  TwoRooms place;
  place.open(1.f, 1.8f, 2.f);
  place.fill({1.4f, 1.4f, 1.6f}, {1.7f, 1.7f, 2.5f},
             CellState::kOccupied);                                     // hangs from the ceiling
  place.fill({4.f, 0.f, 0.f}, {5.f, 3.f, 0.9f}, CellState::kOccupied);  // from wall to wall
  const RoomPlan plan = find_rooms(place.grid);
  ASSERT_EQ(plan.rooms.size(), 2u);
  EXPECT_EQ(plan.room_at({1.5f, 1.5f}), plan.room_at({0.5f, 0.5f}));
  EXPECT_EQ(plan.room_at({3.5f, 1.f}), plan.room_at({5.9f, 1.f}));
}

TEST(RoomPlan, AClosetBelongsToItsRoomAndNothingSeenIsNoRoom) {
  TwoRooms place;
  place.fill({3.6f, 0.f, 0.f}, {3.8f, 3.f, 2.5f}, CellState::kOccupied);
  place.fill({3.2f, 0.8f, 0.f}, {3.6f, 3.f, 2.5f}, CellState::kUnknown);
  place.fill({3.6f, 0.f, 0.f}, {3.8f, 0.7f, 2.5f}, CellState::kFree);  // a closet of 0.3 m2
  EXPECT_EQ(find_rooms(place.grid).rooms.size(), 2u);
  place.fill({0.f, 0.f, 0.f}, {6.2f, 3.f, 2.5f}, CellState::kUnknown);
  EXPECT_TRUE(find_rooms(place.grid).rooms.empty());
}

}  // namespace
}  // namespace ovimap
