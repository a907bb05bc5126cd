// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// For tests only: an analytic room rendered exactly, and tiny recordings of it in each layout.

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>

#include "ovimap/base/error.h"
#include "ovimap/base/temporary_folder_fixture.h"
#include "ovimap/frames/frame/frame.h"
#include "ovimap/image/codec.h"

namespace ovimap::fixture {

namespace fs = std::filesystem;

inline std::string padded(int number, int digits) {
  char text[32];
  std::snprintf(text, sizeof(text), "%0*d", digits, number);
  return text;
}

/// What a ray meets: distance in units of the direction's length, and which surface.
struct Hit {
  double distance = std::numeric_limits<double>::infinity();
  int surface = 0;  ///< 1: sphere, 2 to 7: walls
};

/// The inside of a box [-2,3] x [-1.5,1] x [-1.5,3.5] (metres) with a sphere in it: every ray hits.
inline Hit trace_room(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  static const Eigen::Vector3d kLow(-2, -1.5, -1.5), kHigh(3, 1, 3.5), kCenter(0.4, 0.3, 1.6);
  constexpr double kRadius = 0.45;
  Hit hit;
  for (int axis = 0; axis < 3; ++axis) {
    if (direction[axis] == 0) continue;
    const bool high = direction[axis] > 0;
    const double distance = ((high ? kHigh : kLow)[axis] - origin[axis]) / direction[axis];
    if (distance < hit.distance) hit = {distance, 2 + 2 * axis + (high ? 1 : 0)};
  }
  const Eigen::Vector3d offset = origin - kCenter;
  const double a = direction.squaredNorm(), b = offset.dot(direction);
  const double root = b * b - a * (offset.squaredNorm() - kRadius * kRadius);
  if (root > 0) {
    const double distance = (-b - std::sqrt(root)) / a;
    if (distance > 0 && distance < hit.distance) hit = {distance, 1};
  }
  return hit;
}

/// A camera path through the room, turning and moving, about 2 cm and 1 degree a frame.
inline Pose room_pose(int index) {
  const double t = 0.02 * index;
  Pose pose = Pose::Identity();
  pose.linear() = (Eigen::AngleAxisd(0.5 - 0.9 * t, Eigen::Vector3d::UnitY()) *
                   Eigen::AngleAxisd(0.2 + 0.3 * t, Eigen::Vector3d::UnitX()) *
                   Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitZ()))
                      .toRotationMatrix();
  pose.translation() = Eigen::Vector3d(-0.9 + t, -0.5 + 0.2 * t, -0.6 + 0.3 * t);
  return pose;
}

/// A recording of the room. The defaults are what most tests want; change a member before writing.
struct Sequence {
  PinholeCamera depth_camera{80, 60, 70.f, 70.f, 39.5f, 29.5f};
  PinholeCamera color_camera = depth_camera;
  Pose color_from_depth = Pose::Identity();
  double depth_units_per_m = 1000;
  int frames = 12;
  /// What is written as the pose of a frame; the images always show the true one.
  std::function<Eigen::Matrix4d(const Pose&)> stored_pose = [](const Pose& pose) {
    return pose.matrix();
  };

  DepthImage depth(int index) const {
    const Pose world_from_camera = room_pose(index);
    DepthImage image(depth_camera.width, depth_camera.height);
    for (int v = 0; v < image.height(); ++v)
      for (int u = 0; u < image.width(); ++u) {
        const Eigen::Vector3d ray = depth_camera.unproject(float(u), float(v), 1.f).cast<double>();
        const Hit hit =
            trace_room(world_from_camera.translation(), world_from_camera.linear() * ray);
        image.at(u, v) = static_cast<float>(hit.distance);  // rays have z = 1, so this is the depth
      }
    return image;
  }

  /// Which surface each pixel of the colour camera shows: the true ids.
  IdImage ids(int index) const {
    const Pose world_from_color = room_pose(index) * color_from_depth.inverse();
    IdImage image(color_camera.width, color_camera.height);
    for (int v = 0; v < image.height(); ++v)
      for (int u = 0; u < image.width(); ++u) {
        const Eigen::Vector3d ray = color_camera.unproject(float(u), float(v), 1.f).cast<double>();
        const Hit hit = trace_room(world_from_color.translation(), world_from_color.linear() * ray);
        image.at(u, v) = static_cast<std::uint16_t>(hit.surface);
      }
    return image;
  }

  /// One colour for each surface.
  RgbImage color(int index) const {
    const IdImage surfaces = ids(index);
    RgbImage image(surfaces.width(), surfaces.height());
    for (std::size_t i = 0; i < image.size(); ++i)
      image[i] = {static_cast<std::uint8_t>(30 * surfaces[i]), 100,
                  static_cast<std::uint8_t>(255 - 30 * surfaces[i])};
    return image;
  }

  Image<std::uint16_t> stored_depth(int index) const {
    const DepthImage metres = depth(index);
    Image<std::uint16_t> stored(metres.width(), metres.height());
    for (std::size_t i = 0; i < stored.size(); ++i)
      stored[i] =
          static_cast<std::uint16_t>(std::min(65534.0, std::round(metres[i] * depth_units_per_m)));
    return stored;
  }

  Eigen::Matrix4d pose(int index) const { return stored_pose(room_pose(index)); }
};

/// "a b c d\n..." of the first `rows` rows, on one line when `separator` is a blank.
inline std::string matrix_text(const Eigen::Matrix4d& matrix, char separator = '\n', int rows = 4) {
  std::string text;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < 4; ++column) {
      char number[40];
      std::snprintf(number, sizeof(number), "%.17g%c", matrix(row, column),
                    column < 3 ? ' ' : separator);
      text += number;
    }
  if (separator == ' ') text.back() = '\n';
  return text;
}

inline std::string camera_yaml(const PinholeCamera& camera) {
  return concat("width: ", camera.width, ", height: ", camera.height, ", fx: ", camera.fx,
                ", fy: ", camera.fy, ", cx: ", camera.cx, ", cy: ", camera.cy);
}

/// The calibration.yaml that describes a sequence.
inline std::string calibration_yaml(const Sequence& sequence) {
  const Eigen::AngleAxisd rotation(sequence.color_from_depth.linear());
  const Eigen::Vector3d vector = rotation.angle() * rotation.axis();
  const Eigen::Vector3d offset = sequence.color_from_depth.translation();
  return concat("depth_camera: {", camera_yaml(sequence.depth_camera),
                ", depth_scale: ", sequence.depth_units_per_m, "}\ncolor_camera: {",
                camera_yaml(sequence.color_camera), "}\ncolor_from_depth: {rotation_vector: [",
                vector.x(), ", ", vector.y(), ", ", vector.z(), "], translation: [", offset.x(),
                ", ", offset.y(), ", ", offset.z(), "]}\n");
}

/// frame-NNNNNN.{color.png,depth.png,pose.txt} and calibration.yaml.
inline void write_seven_scenes(const fs::path& folder, const Sequence& sequence) {
  for (int i = 0; i < sequence.frames; ++i) {
    const std::string stem = "frame-" + padded(i, 6);
    write_file(folder / (stem + ".color.png"), encode_png(sequence.color(i)));
    write_file(folder / (stem + ".depth.png"), encode_png(sequence.stored_depth(i)));
    write_text(folder / (stem + ".pose.txt"), matrix_text(sequence.pose(i)));
  }
  write_text(folder / "calibration.yaml", calibration_yaml(sequence));
}

/// ROOT/cam_params.json and ROOT/scene/{results/..., traj.txt}; returns ROOT/scene.
inline fs::path write_replica(const fs::path& root, const Sequence& sequence) {
  const PinholeCamera& camera = sequence.depth_camera;
  write_text(root / "cam_params.json",
             concat("{\"camera\": {\"w\": ", camera.width, ", \"h\": ", camera.height,
                    ", \"fx\": ", camera.fx, ", \"fy\": ", camera.fy, ", \"cx\": ", camera.cx,
                    ", \"cy\": ", camera.cy, ", \"scale\": ", sequence.depth_units_per_m, "}}"));
  fs::create_directories(root / "scene" / "results");
  std::string trajectory;
  for (int i = 0; i < sequence.frames; ++i) {
    const fs::path results = root / "scene" / "results";
    write_file(results / ("frame" + padded(i, 6) + ".jpg"), encode_jpeg(sequence.color(i), 95));
    write_file(results / ("depth" + padded(i, 6) + ".png"), encode_png(sequence.stored_depth(i)));
    write_file(results / ("instance" + padded(i, 6) + ".png"), encode_png(sequence.ids(i)));
    trajectory += matrix_text(sequence.pose(i), ' ');
  }
  write_text(root / "scene" / "traj.txt", trajectory);
  return root / "scene";
}

/// "tx ty tz qx qy qz qw" of a pose.
inline std::string tum_text(const Eigen::Matrix4d& matrix) {
  const Eigen::Quaterniond q(Eigen::Matrix3d(matrix.topLeftCorner<3, 3>()));
  char text[256];
  std::snprintf(text, sizeof(text), "%.9f %.9f %.9f %.9f %.9f %.9f %.9f", matrix(0, 3),
                matrix(1, 3), matrix(2, 3), q.x(), q.y(), q.z(), q.w());
  return text;
}

/// rgb/, depth/, rgb.txt, depth.txt (10 ms later), groundtruth.txt (5 ms after depth),
/// calibration.yaml.
inline void write_tum(const fs::path& folder, const Sequence& sequence) {
  fs::create_directories(folder / "rgb");
  fs::create_directories(folder / "depth");
  std::string rgb = "# color images\n", depth = "# depth maps\n", poses = "# ground truth\n";
  for (int i = 0; i < sequence.frames; ++i) {
    const std::string time = concat("1305031102.", padded(100 + 33 * i, 3));
    write_file(folder / "rgb" / (time + ".png"), encode_png(sequence.color(i)));
    write_file(folder / "depth" / (time + "1.png"), encode_png(sequence.stored_depth(i)));
    rgb += concat(time, " rgb/", time, ".png\n");
    depth += concat("1305031102.", padded(110 + 33 * i, 3), " depth/", time, "1.png\n");
    poses += concat("1305031102.", padded(115 + 33 * i, 3), " ", tum_text(sequence.pose(i)), "\n");
  }
  write_text(folder / "rgb.txt", rgb);
  write_text(folder / "depth.txt", depth);
  write_text(folder / "groundtruth.txt", poses);
  write_text(folder / "calibration.yaml", calibration_yaml(sequence));
}

/// color/N.png and depth/N.png, and camera.yaml; poses are left to the test.
inline void write_folder(const fs::path& folder, const Sequence& sequence) {
  fs::create_directories(folder / "color");
  fs::create_directories(folder / "depth");
  for (int i = 0; i < sequence.frames; ++i) {
    write_file(folder / "color" / concat(i, ".png"), encode_png(sequence.color(i)));
    write_file(folder / "depth" / concat(i, ".png"), encode_png(sequence.stored_depth(i)));
  }
  write_text(folder / "camera.yaml", calibration_yaml(sequence));
}

}  // namespace ovimap::fixture
