// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/frame/lens.h"

#include <vector>

#include <gtest/gtest.h>

namespace ovimap {
namespace {

using Rays = std::vector<Eigen::Vector2d>;

const Rays kRays = {{0, 0}, {0.3, 0.2}, {-0.5, 0.4}, {0.6, -0.45}, {-0.2, -0.7}};

void expect_bent(const Lens& lens, const Rays& expected) {
  for (std::size_t i = 0; i < kRays.size(); ++i)
    EXPECT_LT((lens.bend(kRays[i]) - expected[i]).norm(), 1e-12) << i;
}

TEST(Lens, LeavesRaysOfAPinholeAlone) {
  expect_bent({}, kRays);
}

// The expected values are those of OpenCV 5.0.0 with an identity camera matrix: cv2.projectPoints
// and cv2.fisheye.projectPoints of (x, y, 1).

TEST(Lens, BrownConradyOfFiveNumbersIsOpenCVs) {
  expect_bent({Lens::Model::kBrownConrady, {.1, -.2, .01, .02, .03}},
              {{0, 0},
               {0.31030577299999995, 0.206437182},
               {-0.490523815, 0.40307905199999994},
               {0.6192348632812499, -0.4503636474609375},
               {-0.18525726200000003, -0.6802004169999999}});
  expect_bent({Lens::Model::kBrownConrady, {.2624, -.9531, -.0054, .0026, 1.1633}},
              {{0, 0},
               {0.30632611403, 0.20329007602000004},
               {-0.50924584465, 0.40603547572000004},
               {0.6380958662109375, -0.4805125246582031},
               {-0.20883296482000005, -0.73860037687}});
}

TEST(Lens, BrownConradyOfEightNumbersIsOpenCVs) {
  expect_bent({Lens::Model::kBrownConrady, {.4, -.3, .001, -.002, .05, .6, -.1, .02}},
              {{0, 0},
               {0.2913296141508991, 0.1945230761005994},
               {-0.45608182184002416, 0.3646194574720194},
               {0.5187953687972883, -0.38937777659796624},
               {-0.17654287571492874, -0.6136600650022506}});
}

TEST(Lens, KannalaBrandtIsOpenCVsFisheye) {
  expect_bent({Lens::Model::kKannalaBrandt, {.05, -.02, .006, -.001}},
              {{0, 0},
               {0.2895727315570745, 0.1930484877047164},
               {-0.45109513275191954, 0.36087610620153565},
               {0.5238983689962771, -0.3929237767472078},
               {-0.17581709627341802, -0.6153598369569631}});
}

}  // namespace
}  // namespace ovimap
