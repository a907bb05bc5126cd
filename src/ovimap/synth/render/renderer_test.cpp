// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/render/renderer.h"

#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>

#include <gtest/gtest.h>

#include "ovimap/base/parallel.h"
#include "ovimap/synth/buildings/room_builder.h"
#include "ovimap/synth/camera/trajectory.h"
#include "ovimap/synth/shapes/mesh_parts.h"

namespace ovimap {
namespace {

const PinholeCamera kViewCamera{80, 60, 60, 60, 39.5f, 29.5f};

/// The bare room with a box floating in it, half a metre a side.
SynthRoom room_with_box() {
  SynthRoom room = build_room(room_spec("bare"));
  RoomObject box;
  box.id = static_cast<std::uint16_t>(room.objects.size() + 1);
  box.name = box.class_name = "box";
  add_box(box.mesh, {1.5f, 1.2f, 0.6f}, {2, 1.7f, 1.1f}, add_material(box.mesh, {}));
  box.box = bounds(box.mesh);
  room.objects.push_back(std::move(box));
  return room;
}

class RendererTest : public testing::Test {
 protected:
  SynthRoom room_ = room_with_box();
  Renderer renderer_{room_};
  Pose pose_ = looking({0.4, 0.5, 1.5}, 0.75, -0.4, 0.05);
};

TEST_F(RendererTest, DepthIsExactOnEveryPlane) {
  const RenderedView view = renderer_.render(kViewCamera, pose_, false);
  std::array<int, 9> pixels{};
  for (int y = 0; y < kViewCamera.height; ++y)
    for (int x = 0; x < kViewCamera.width; ++x) {
      const std::uint16_t id = view.ids.at(x, y);
      const Eigen::Vector3d ray((x - kViewCamera.cx) / kViewCamera.fx,
                                (y - kViewCamera.cy) / kViewCamera.fy, 1);
      const Eigen::Vector3d p = pose_ * (static_cast<double>(view.depth.at(x, y)) * ray);
      const RoomObject& object = room_.objects.at(id - 1u);
      ++pixels.at(id);
      if (object.name == "floor") {
        ASSERT_NEAR(p.z(), 0, 1e-5);
      }
      if (object.name == "ceiling") {
        ASSERT_NEAR(p.z(), 2.5, 1e-5);
      }
      if (object.name == "east wall" && p.z() > 0.1) {
        ASSERT_NEAR(p.x(), 3.6, 1e-5);
      }
      if (object.name == "north wall" && p.z() > 0.1) {
        ASSERT_NEAR(p.y(), 3.1, 1e-5);
      }
      const Eigen::Vector3f place = p.cast<float>();
      ASSERT_LT(object.box.exteriorDistance(place), 1e-5f) << object.name;  // ids and depth agree
    }
  EXPECT_GT(pixels[1], 100);                    // floor
  EXPECT_GT(pixels[3] + pixels[4], 100);        // east and north wall
  EXPECT_GT(pixels[room_.objects.size()], 50);  // the box
}

TEST_F(RendererTest, LeavesAllThreadsToWhoeverWorksBeside) {
  if (std::thread::hardware_concurrency() < 2) GTEST_SKIP() << "one core";
  std::atomic<int> here = 0;
  std::atomic<bool> alone = false;
  // Each of the two waits for the other, as only two threads can.
  parallel_for(2, 1, [&](std::size_t) {
    ++here;
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (here < 2 && std::chrono::steady_clock::now() < end) std::this_thread::yield();
    if (here < 2) alone = true;
  });
  EXPECT_FALSE(alone);
}

TEST_F(RendererTest, IncidenceIsTheAngleToTheSurface) {
  const RenderedView view =
      renderer_.render(kViewCamera, looking({1.8, 0.6, 2}, 0, -1.5707963, 0), false);
  EXPECT_NEAR(view.incidence_cos.at(39, 29), 1, 1e-3);
  const double slant = std::hypot(39.5 / 60, 29.5 / 60);
  EXPECT_EQ(view.ids.at(0, 0), 1);
  EXPECT_NEAR(view.incidence_cos.at(0, 0), 1 / std::sqrt(1 + slant * slant), 1e-4);
}

TEST_F(RendererTest, ThreadsDoNotChangeAnything) {
  const RenderedView many = renderer_.render(kViewCamera, pose_);
  const ThreadLimit limit(1);
  const RenderedView one = Renderer(room_).render(kViewCamera, pose_);
  EXPECT_EQ(many.color, one.color);
  EXPECT_EQ(many.depth, one.depth);
  EXPECT_EQ(many.ids, one.ids);
}

TEST_F(RendererTest, TheBoxThrowsAShadow) {
  // The lamp hangs in the middle of the ceiling: the floor below the box is darker than beside it.
  const auto brightness = [&](const Eigen::Vector3d& eye) {
    const Rgb8 color =
        renderer_.render(kViewCamera, looking(eye, 0, -1.5707963, 0)).color.at(39, 29);
    return color.r + color.g + color.b;
  };
  EXPECT_LT(brightness({1.75, 1.45, 0.5}), 0.8 * brightness({0.7, 0.7, 0.5}));
}

TEST_F(RendererTest, RaysThatLeaveTheRoomSeeNothing) {
  const RenderedView view = renderer_.render(kViewCamera, looking({9, 9, 1}, 0.8, 0, 0));
  EXPECT_EQ(view.ids, IdImage(80, 60, 0));
  EXPECT_EQ(view.depth, DepthImage(80, 60, 0.f));
  EXPECT_EQ(view.color, RgbImage(80, 60));
}

TEST(TextureTest, FarSurfacesShowTheMeanAndNearOnesTheirPixels) {
  RgbImage image(8, 8);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) image.at(x, y) = (x + y) % 2 ? Rgb8{255, 255, 255} : Rgb8{0, 0, 0};
  const Texture texture(image);
  const Eigen::Vector2f corner(0.5f / 8, 1 - 0.5f / 8);  // the middle of the upper left pixel
  EXPECT_NEAR(texture.sample(corner, 1).x(), 0, 1e-4f);
  EXPECT_NEAR(texture.sample(corner, 16).x(), 0.5f, 0.01f);
  EXPECT_NEAR(texture.sample(corner + Eigen::Vector2f(3, -2), 1).x(), 0, 1e-4f);  // repeats
}

TEST(TextureTest, LightAndBytesAreInverse) {
  for (int i = 0; i < 256; ++i)
    EXPECT_NEAR(srgb_from_linear(linear_from_srgb(static_cast<std::uint8_t>(i))), i,
                i < 12 ? 1 : 0);
}

}  // namespace
}  // namespace ovimap
