// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/pictures/pictures.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_map>
#include <vector>

#include "ovimap/base/config.h"
#include "ovimap/base/parallel.h"
#include "ovimap/image/resize.h"
#include "ovimap/io/pictures/palette.h"
#include "ovimap/io/pictures/pictures_raster.h"
#include "ovimap/io/pictures/pictures_scale_bar.h"
#include "ovimap/io/pictures/scene_axes.h"

namespace ovimap {

namespace {

constexpr Rgb8 kGround = {247, 247, 244};
constexpr float kMargin = 0.04f;  // around a view from above, as a share of its longest side
constexpr std::size_t kRowsPerTask = 16;

/// Shades the foremost triangle of each pixel.
class Shader {
 public:
  Shader(const Mesh& mesh, const RasterView& view, const PictureConfig& config)
      : mesh_(mesh),
        config_(config),
        world_from_camera_(view.world_from_camera.cast<float>()),
        to_lamp_(world_from_camera_.linear() *
                 Eigen::Vector3f(-0.35f, -0.55f, -0.75f).normalized()) {
    if (config.coloring == MeshColoring::kInstances)
      colors_ = instance_colors(mesh.labels);
    else
      colors_ = mesh.colors;
    if (colors_.empty()) {
      const Rgb8 grey = instance_color(0);
      colors_.assign(mesh.vertices.size(), {grey.r, grey.g, grey.b});
    }
  }

  Rgb8 shade(std::uint32_t triangle, const Eigen::Vector3f& point_in_camera) const {
    const auto& t = mesh_.triangles[triangle];
    const Eigen::Vector3f &a = mesh_.vertices[t[0]], &b = mesh_.vertices[t[1]],
                          &c = mesh_.vertices[t[2]];
    const Eigen::Vector3f face = (b - a).cross(c - a);
    const Eigen::Vector3f p = world_from_camera_ * point_in_camera;
    // Barycentric weights of the point, from the areas it spans with the edges.
    const float squared = face.squaredNorm();
    const float wa = (c - b).cross(p - b).dot(face) / squared,
                wb = (a - c).cross(p - c).dot(face) / squared;
    const Eigen::Vector3f weights(wa, wb, 1 - wa - wb);
    const float light = lit(normal_at(t, weights, face));
    const Eigen::Vector3f color = color_at(t, weights) * light;
    const auto byte = [](float value) {
      return static_cast<std::uint8_t>(std::clamp(value, 0.f, 255.f) + 0.5f);
    };
    return {byte(color.x()), byte(color.y()), byte(color.z())};
  }

 private:
  using Corners = std::array<std::uint32_t, 3>;

  Eigen::Vector3f normal_at(const Corners& t, const Eigen::Vector3f& weights,
                            const Eigen::Vector3f& face) const {
    if (mesh_.normals.empty()) return face.normalized();
    return (mesh_.normals[t[0]] * weights[0] + mesh_.normals[t[1]] * weights[1] +
            mesh_.normals[t[2]] * weights[2])
        .normalized();
  }

  /// Two-sided, as some truth meshes have faces of either orientation.
  float lit(const Eigen::Vector3f& normal) const {
    return config_.ambient + (1 - config_.ambient) * std::abs(normal.dot(to_lamp_));
  }

  Eigen::Vector3f color_at(const Corners& t, const Eigen::Vector3f& weights) const {
    const auto color = [&](std::uint32_t vertex) {
      const auto& [r, g, b] = colors_[vertex];
      return Eigen::Vector3f(r, g, b);
    };
    if (config_.coloring == MeshColoring::kColors)
      return color(t[0]) * weights[0] + color(t[1]) * weights[1] + color(t[2]) * weights[2];
    // Instances are never mixed: the nearest corner decides.
    int nearest = 0;
    weights.maxCoeff(&nearest);
    return color(t[static_cast<std::size_t>(nearest)]);
  }

  const Mesh& mesh_;
  const PictureConfig& config_;
  Eigen::Isometry3f world_from_camera_;
  Eigen::Vector3f to_lamp_;
  std::vector<std::array<std::uint8_t, 3>> colors_;
};

/// Draws at `supersampling` times the size and shrinks.
RgbImage draw(const Mesh& mesh, RasterView view, const PictureConfig& config) {
  const int width = view.camera.width, height = view.camera.height;
  view.camera = view.camera.scaled_to(width * config.supersampling, height * config.supersampling);
  const RasterResult raster = rasterize(mesh, view);
  const Shader shader(mesh, view, config);
  RgbImage image(view.camera.width, view.camera.height, kGround);
  parallel_for(static_cast<std::size_t>(image.height()), kRowsPerTask, [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < image.width(); ++x) {
      const std::uint32_t triangle = raster.triangle.at(x, y);
      if (triangle == RasterResult::kNoTriangle) continue;
      image.at(x, y) = shader.shade(triangle, point_in_camera(view, x, y, raster.depth_m.at(x, y)));
    }
  });
  return config.supersampling == 1 ? image : resize_bilinear(image, width, height);
}

struct Interval {
  float low = 0, high = 0;
  float length() const { return high - low; }
};

/// The interval of the vertices along a direction, without `trim` of them at each end.
Interval extent(const Mesh& mesh, const Eigen::Vector3f& direction, float trim) {
  std::vector<float> along;
  along.reserve(mesh.vertices.size());
  for (const Eigen::Vector3f& vertex : mesh.vertices) along.push_back(vertex.dot(direction));
  const auto skipped = static_cast<std::ptrdiff_t>(trim * static_cast<float>(along.size()));
  std::nth_element(along.begin(), along.begin() + skipped, along.end());
  const float low = along[static_cast<std::size_t>(skipped)];
  std::nth_element(along.begin(), along.end() - 1 - skipped, along.end());
  return {low, *(along.end() - 1 - skipped)};
}

/// A camera over the mesh that looks down; the longer side of the scene lies across the picture.
RasterView view_from_above(const Mesh& mesh, const Eigen::Vector3f& up, const PictureConfig& config,
                           std::optional<float> max_height_m) {
  Eigen::Vector3f right = guess_wall_direction(mesh, up), down = right.cross(up);
  Interval across = extent(mesh, right, config.trim), along = extent(mesh, down, config.trim);
  if (along.length() > across.length()) {
    right = down, down = right.cross(up);
    across = extent(mesh, right, config.trim), along = extent(mesh, down, config.trim);
  }
  const Interval height = extent(mesh, up, config.trim);
  const float top = max_height_m.value_or(height.high - config.drop_top * height.length());

  const float longest_m = std::max(across.length(), 1e-3f);
  const float margin_m = kMargin * longest_m;
  const float px_per_m = static_cast<float>(config.longest_side_px) / (longest_m + 2 * margin_m);
  RasterView view;
  view.orthographic = true;
  view.cull_back_faces = config.cull_back_faces;
  view.near_m = 0;  // the camera floats at the height of the cut
  view.camera = {
      config.longest_side_px,
      std::max(1, static_cast<int>(std::ceil(px_per_m * (along.length() + 2 * margin_m)))),
      px_per_m,
      px_per_m,
      px_per_m * margin_m,
      px_per_m * margin_m};
  view.world_from_camera.linear().col(0) = right.cast<double>();
  view.world_from_camera.linear().col(1) = down.cast<double>();
  view.world_from_camera.linear().col(2) = -up.cast<double>();
  view.world_from_camera.translation() =
      (across.low * right + along.low * down + top * up).cast<double>();
  return view;
}

}  // namespace

void list_fields(PictureConfig& config, ConfigFields& fields) {
  fields.add_choice<MeshColoring>(
      "coloring", config.coloring,
      {{"instances", MeshColoring::kInstances}, {"colors", MeshColoring::kColors}},
      "what the colours show");
  fields.add("longest_side_px", config.longest_side_px, 16, 20000,
             "width of a view from above, in pixels");
  fields.add("supersampling", config.supersampling, 1, 8, "samples per pixel along each side");
  fields.add("ambient", config.ambient, 0.f, 1.f, "light that reaches every surface");
  fields.add("drop_top", config.drop_top, 0.f, 1.f,
             "share of the height cut from a view from above");
  fields.add("trim", config.trim, 0.f, 0.4f, "share of stray vertices that do not widen the view");
  fields.add("cull_back_faces", config.cull_back_faces,
             "whether faces seen from behind are left out");
  fields.add("scale_bar", config.scale_bar, "whether a view from above has a scale bar");
}

RgbImage top_down(const Mesh& mesh, const Eigen::Vector3f& up, const PictureConfig& config,
                  std::optional<float> max_height_m) {
  if (mesh.triangles.empty())
    return RgbImage(config.longest_side_px, config.longest_side_px, kGround);
  const RasterView view = view_from_above(mesh, up.normalized(), config, max_height_m);
  RgbImage image = draw(mesh, view, config);
  if (config.scale_bar) draw_scale_bar(image, view.camera.fx);
  return image;
}

RgbImage perspective(const Mesh& mesh, const PinholeCamera& camera, const Pose& world_from_camera,
                     const PictureConfig& config) {
  RasterView view;
  view.camera = camera;
  view.world_from_camera = world_from_camera;
  view.cull_back_faces = config.cull_back_faces;
  return draw(mesh, view, config);
}

Pose look_at(const Eigen::Vector3d& eye, const Eigen::Vector3d& target, const Eigen::Vector3d& up) {
  const Eigen::Vector3d forward = (target - eye).normalized();
  const Eigen::Vector3d right = forward.cross(up).normalized();
  Pose world_from_camera = Pose::Identity();
  world_from_camera.linear().col(0) = right;
  world_from_camera.linear().col(1) = forward.cross(right);
  world_from_camera.linear().col(2) = forward;
  world_from_camera.translation() = eye;
  return world_from_camera;
}

}  // namespace ovimap
