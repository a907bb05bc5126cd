// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/pictures/scene_axes.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "ovimap/base/config.h"

namespace ovimap {
namespace {

using Eigen::Vector3f;

void add_quad(Mesh& mesh, const Vector3f& corner, const Vector3f& u, const Vector3f& v) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Vector3f& vertex :
       {corner, Vector3f(corner + u), Vector3f(corner + u + v), Vector3f(corner + v)})
    mesh.vertices.push_back(vertex);
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

/// Floor, ceiling and walls of a 4 x 3 x 2.5 m attic seen from inside, z up, and a slanted roof
/// light.
Mesh attic() {
  Mesh mesh;
  add_quad(mesh, {0, 0, 0}, {4, 0, 0}, {0, 3, 0});
  add_quad(mesh, {0, 0, 2.5f}, {0, 3, 0}, {4, 0, 0});
  add_quad(mesh, {0, 0, 0}, {0, 3, 0}, {0, 0, 2.5f});
  add_quad(mesh, {4, 0, 0}, {0, 0, 2.5f}, {0, 3, 0});
  add_quad(mesh, {0, 0, 0}, {0, 0, 2.5f}, {4, 0, 0});
  add_quad(mesh, {0, 3, 0}, {4, 0, 0}, {0, 0, 2.5f});
  add_quad(mesh, {0, 0, 1}, {1, 0, 0}, {0, 1, 0.5f});
  return mesh;
}

/// Cameras that look along the horizon of a z-up world in all directions, pitched down.
std::vector<Pose> cameras_pitched_by(double degrees) {
  std::vector<Pose> cameras;
  for (int i = 0; i < 3; ++i) {  // only over a quarter, so that their mean up is tilted
    Pose pose = Pose::Identity();
    pose.rotate(Eigen::AngleAxisd(0.5 * i, Eigen::Vector3d::UnitZ()));
    // x right, y down, z forward of a camera that looks along world y.
    Eigen::Matrix3d level;
    level.col(0) = Eigen::Vector3d::UnitX(), level.col(1) = -Eigen::Vector3d::UnitZ(),
    level.col(2) = Eigen::Vector3d::UnitY();
    pose.rotate(level * Eigen::AngleAxisd(-degrees * EIGEN_PI / 180, Eigen::Vector3d::UnitX()));
    cameras.push_back(pose);
  }
  return cameras;
}

TEST(GuessUp, FindsTheFloorInAWorldTurnedAnyWay) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> real(-1, 1);
  for (int round = 0; round < 20; ++round) {
    const Eigen::Quaterniond turn =
        Eigen::Quaterniond(real(random), real(random), real(random), real(random)).normalized();
    Mesh mesh = attic();
    for (Vector3f& vertex : mesh.vertices) vertex = turn.cast<float>() * vertex;
    std::vector<Pose> cameras = cameras_pitched_by(35);
    for (Pose& pose : cameras) pose = turn * pose;
    const Vector3f up = guess_up(mesh, cameras), expected = turn.cast<float>() * Vector3f::UnitZ();
    EXPECT_NEAR(up.dot(expected), 1, 1e-5) << round;
  }
}

TEST(GuessUp, AveragesANoisyFloor) {
  std::mt19937 random(4);
  std::normal_distribution<float> noise(0, 0.002f);
  Mesh mesh;
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 40; ++x)
      mesh.vertices.emplace_back(0.05f * static_cast<float>(x), 0.05f * static_cast<float>(y),
                                 noise(random));
  for (std::uint32_t y = 0; y < 39; ++y)
    for (std::uint32_t x = 0; x < 39; ++x)
      mesh.triangles.push_back({40 * y + x, 40 * y + x + 1, 40 * y + x + 40});
  EXPECT_GT(guess_up(mesh, cameras_pitched_by(30)).z(), std::cos(0.5 * EIGEN_PI / 180));
}

TEST(GuessUp, TakesTheCamerasWordWhereNoSurfaceHelps) {
  const std::vector<Pose> level = cameras_pitched_by(0);
  EXPECT_TRUE(guess_up(Mesh{}, level).isApprox(Vector3f::UnitZ(), 1e-5f));
  Mesh wall;
  add_quad(wall, {0, 0, 0}, {0, 3, 0}, {0, 0, 2.5f});
  EXPECT_TRUE(guess_up(wall, level).isApprox(Vector3f::UnitZ(), 1e-5f));
  EXPECT_EQ(guess_up(attic(), {}), Vector3f::UnitZ());
}

TEST(GuessWallDirection, LiesAlongTheWalls) {
  for (const float degrees : {0.f, 10.f, 44.f, 80.f}) {
    Mesh mesh = attic();
    add_quad(mesh, {1, 1, 0}, {0.7f, 0.5f, 0}, {0, 0, 1});  // a screen across the attic
    const Eigen::AngleAxisf turn(degrees * static_cast<float>(EIGEN_PI) / 180, Vector3f::UnitZ());
    for (Vector3f& vertex : mesh.vertices) vertex = turn * vertex;
    SurfaceDirections directions;
    directions.add(mesh);
    const Vector3f direction = guess_wall_direction(directions, Vector3f::UnitZ());
    const float along_x = std::abs(direction.dot(turn * Vector3f::UnitX()));
    const float along_y = std::abs(direction.dot(turn * Vector3f::UnitY()));
    EXPECT_GT(std::max(along_x, along_y), std::cos(0.1 * EIGEN_PI / 180)) << degrees;
    EXPECT_NEAR(direction.z(), 0, 1e-6);
  }
  SurfaceDirections none;
  EXPECT_NEAR(guess_wall_direction(none, Vector3f::UnitY()).norm(), 1, 1e-6);
}

TEST(GuessWallDirection, DoesNotTurnWithALittleLean) {
  SurfaceDirections directions;
  for (const Vector3f& up : {Vector3f(0, 0, 1), Vector3f(0, 1, 0), Vector3f(-1, 0, 0)})
    for (const float x : {-0.01f, 0.01f})
      for (const float y : {-0.01f, 0.01f}) {
        const Vector3f leaning = (up + Vector3f(x, y, x + y)).normalized();
        EXPECT_GT(
            guess_wall_direction(directions, leaning).dot(guess_wall_direction(directions, up)),
            0.99f)
            << up.transpose() << ", " << x << " " << y;
      }
}

TEST(SceneAxesConfig, ListsItsFields) {
  SceneAxesConfig config;
  ConfigFields fields;
  list_fields(config, fields);
  fields.set("cone_deg", "30");
  // The tilted mean up of the cameras is now farther from the floor's normal than the cone.
  EXPECT_LT(guess_up(attic(), cameras_pitched_by(35), config).z(), 0.99f);
}

}  // namespace
}  // namespace ovimap
