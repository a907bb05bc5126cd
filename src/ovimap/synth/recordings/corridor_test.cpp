// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/recordings/corridor.h"

#include <set>

#include <gtest/gtest.h>

namespace ovimap {
namespace {

TEST(Corridor, EveryPointLiesOnASurface) {
  const CorridorSource corridor({.frames = 200});
  for (const std::int64_t position : {0, 57, 199}) {
    const Frame frame = *corridor.read(position).frame;
    const IdImage ids = *corridor.truth_ids(position);
    std::set<std::uint16_t> seen;
    for (int y = 0; y < frame.depth.height(); y += 3)
      for (int x = 0; x < frame.depth.width(); x += 3) {
        if (ids.at(x, y) == 0) {
          EXPECT_EQ(frame.depth.at(x, y), 0.f);
          continue;
        }
        seen.insert(ids.at(x, y));
        const Eigen::Vector3f point =
            frame.world_from_camera.cast<float>() *
            frame.depth_camera.unproject(static_cast<float>(x), static_cast<float>(y),
                                         frame.depth.at(x, y));
        if (ids.at(x, y) >= 5) {
          const Eigen::AlignedBox3f& box = corridor.boxes()[ids.at(x, y) - 5u];
          EXPECT_LT(box.exteriorDistance(point), 1e-3f);
        } else {
          const float off = std::min({std::abs(point.z()), std::abs(point.z() - 2.5f),
                                      std::abs(std::abs(point.y()) - 1.f)});
          EXPECT_LT(off, 1e-3f);
        }
      }
    EXPECT_GT(seen.size(), 5u) << "floor, walls and boxes";
  }
}

TEST(Corridor, IsTheSameEveryTimeAndGoesOn) {
  const CorridorSource corridor({.frames = 1000});
  EXPECT_EQ(corridor.read(500).frame->depth, corridor.read(500).frame->depth);
  EXPECT_NEAR(corridor.read(999).frame->world_from_camera.translation().x(), 999 * 0.06, 1e-3);
}

}  // namespace
}  // namespace ovimap
