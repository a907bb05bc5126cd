// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/pictures/pictures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
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
constexpr std::size_t kMostVertices = 1u << 22;  // that tell how large a scene is

/// Shades the foremost triangle of each pixel.
class Shader {
 public:
  Shader(const Mesh& mesh, const RasterView& view, MeshColoring coloring,
         const PictureConfig& config)
      : mesh_(mesh),
        coloring_(coloring),
        config_(config),
        world_from_camera_(view.world_from_camera.cast<float>()),
        to_lamp_(world_from_camera_.linear() *
                 Eigen::Vector3f(-0.35f, -0.55f, -0.75f).normalized()) {
    if (coloring == MeshColoring::kInstances)
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
    if (coloring_ == MeshColoring::kColors)
      return color(t[0]) * weights[0] + color(t[1]) * weights[1] + color(t[2]) * weights[2];
    // Instances are never mixed: the nearest corner decides.
    int nearest = 0;
    weights.maxCoeff(&nearest);
    return color(t[static_cast<std::size_t>(nearest)]);
  }

  const Mesh& mesh_;
  const MeshColoring coloring_;
  const PictureConfig& config_;
  Eigen::Isometry3f world_from_camera_;
  Eigen::Vector3f to_lamp_;
  std::vector<std::array<std::uint8_t, 3>> colors_;
};

/// Pictures of a mesh that comes in parts, one for each colouring, drawn at `supersampling` times
/// the size and shrunk.
class Canvas {
 public:
  Canvas(const RasterView& view, std::span<const MeshColoring> colorings,
         const PictureConfig& config)
      : config_(config),
        size_(view.camera.width, view.camera.height),
        view_(enlarged(view, config.supersampling)),
        raster_(view_),
        colorings_(colorings.begin(), colorings.end()),
        images_(colorings.size(), RgbImage(view_.camera.width, view_.camera.height, kGround)) {}

  void add(const Mesh& part) {
    const RasterResult raster = raster_.draw(part);
    for (std::size_t i = 0; i < images_.size(); ++i)
      paint(raster, Shader(part, view_, colorings_[i], config_), images_[i]);
  }

  std::vector<RgbImage> finish() {
    if (config_.supersampling > 1)
      for (RgbImage& image : images_) image = resize_bilinear(image, size_.x(), size_.y());
    return std::move(images_);
  }

 private:
  static RasterView enlarged(RasterView view, int times) {
    view.camera = view.camera.scaled_to(view.camera.width * times, view.camera.height * times);
    return view;
  }

  void paint(const RasterResult& raster, const Shader& shader, RgbImage& image) const {
    parallel_for(static_cast<std::size_t>(image.height()), kRowsPerTask, [&](std::size_t row) {
      const int y = static_cast<int>(row);
      for (int x = 0; x < image.width(); ++x) {
        const std::uint32_t triangle = raster.triangle.at(x, y);
        if (triangle == RasterResult::kNoTriangle) continue;
        image.at(x, y) =
            shader.shade(triangle, point_in_camera(view_, x, y, raster.depth_m.at(x, y)));
      }
    });
  }

  const PictureConfig& config_;
  const Eigen::Vector2i size_;
  const RasterView view_;
  PartRasterizer raster_;
  const std::vector<MeshColoring> colorings_;
  std::vector<RgbImage> images_;
};

struct Interval {
  float low = 0, high = 0;
  float length() const { return high - low; }
};

/// Where the surface of a mesh that comes in parts lies and how it faces, in bounded memory.
struct SceneExtent {
  SurfaceDirections directions;
  std::vector<Eigen::Vector3f> vertices;  ///< every step-th
  std::size_t step = 1, count = 0;

  void add(const Mesh& part) {
    directions.add(part);
    for (const Eigen::Vector3f& vertex : part.vertices)
      if (count++ % step == 0) vertices.push_back(vertex);
    while (vertices.size() > kMostVertices) {
      for (std::size_t i = 0; 2 * i < vertices.size(); ++i) vertices[i] = vertices[2 * i];
      vertices.resize((vertices.size() + 1) / 2);
      step *= 2;
    }
  }

  /// The interval of the vertices along a direction, without `trim` of them at each end.
  Interval along(const Eigen::Vector3f& direction, float trim) const {
    std::vector<float> places;
    places.reserve(vertices.size());
    for (const Eigen::Vector3f& vertex : vertices) places.push_back(vertex.dot(direction));
    const auto skipped = static_cast<std::ptrdiff_t>(trim * static_cast<float>(places.size()));
    std::nth_element(places.begin(), places.begin() + skipped, places.end());
    const float low = places[static_cast<std::size_t>(skipped)];
    std::nth_element(places.begin(), places.end() - 1 - skipped, places.end());
    return {low, *(places.end() - 1 - skipped)};
  }
};

/// A camera over the scene that looks down; the longer side of the scene lies across the picture.
RasterView view_from_above(SceneExtent& scene, const Eigen::Vector3f& up,
                           const PictureConfig& config, std::optional<float> max_height_m) {
  Eigen::Vector3f right = guess_wall_direction(scene.directions, up), down = right.cross(up);
  Interval across = scene.along(right, config.trim), along = scene.along(down, config.trim);
  if (along.length() > across.length()) {
    right = down, down = right.cross(up);
    across = scene.along(right, config.trim), along = scene.along(down, config.trim);
  }
  const Interval height = scene.along(up, config.trim);
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

std::vector<RgbImage> top_down(const MeshParts& parts, const Eigen::Vector3f& up,
                               std::span<const MeshColoring> colorings, const PictureConfig& config,
                               std::optional<float> max_height_m) {
  SceneExtent scene;
  bool any = false;
  parts([&](const Mesh& part) {
    scene.add(part);
    any = any || !part.triangles.empty();
  });
  if (!any)
    return std::vector<RgbImage>(colorings.size(),
                                 RgbImage(config.longest_side_px, config.longest_side_px, kGround));
  const RasterView view = view_from_above(scene, up.normalized(), config, max_height_m);
  Canvas canvas(view, colorings, config);
  parts([&](const Mesh& part) { canvas.add(part); });
  std::vector<RgbImage> images = canvas.finish();
  if (config.scale_bar)
    for (RgbImage& image : images) draw_scale_bar(image, view.camera.fx);
  return images;
}

RgbImage top_down(const Mesh& mesh, const Eigen::Vector3f& up, const PictureConfig& config,
                  std::optional<float> max_height_m) {
  const MeshParts whole = [&](const auto& visit) { visit(mesh); };
  return std::move(top_down(whole, up, {&config.coloring, 1}, config, max_height_m).front());
}

}  // namespace ovimap
