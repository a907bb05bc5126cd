// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/render/renderer.h"

#include <array>
#include <cmath>
#include <limits>

#include "ovimap/base/config.h"
#include "ovimap/base/parallel.h"
#include "ovimap/synth/render/lighting.h"
#include "ovimap/synth/render/motion_blur.h"
#include "ovimap/synth/render/surface_tracer.h"

namespace ovimap {
namespace {

constexpr std::size_t kRenderedRowsPerTask = 4;
constexpr float kEdgeDepthRatio =
    0.02f;  // neighbours farther apart than this share of depth: an edge
constexpr float kEdgeNormal = 0.9f;
// Inside a pixel, at the corners of a rotated square: no two share a row or column.
constexpr std::array<std::array<double, 2>, 4> kSubPixels = {
    {{-0.125, -0.375}, {0.375, -0.125}, {-0.375, 0.125}, {0.125, 0.375}}};

template <class Body>
void for_each_pixel(int width, int height, const Body& body) {
  parallel_for(static_cast<std::size_t>(height), kRenderedRowsPerTask, [&](std::size_t row) {
    for (int x = 0; x < width; ++x) body(x, static_cast<int>(row));
  });
}

bool differs(const SurfacePoint& a, const SurfacePoint& b) {
  return a.id != b.id || std::abs(a.depth - b.depth) > kEdgeDepthRatio * a.depth ||
         (a.id != 0 && a.face_normal.dot(b.face_normal) < kEdgeNormal);
}

bool on_edge(const Image<SurfacePoint>& surfaces, int x, int y) {
  const SurfacePoint& center = surfaces.at(x, y);
  for (const auto [dx, dy] : {std::array{1, 0}, {-1, 0}, {0, 1}, {0, -1}})
    if (surfaces.contains(x + dx, y + dy) && differs(center, surfaces.at(x + dx, y + dy)))
      return true;
  return false;
}

/// The light of the neighbouring pixel whose surface is most like `point`.
const Eigen::Vector3f& borrowed_light(const Image<SurfacePoint>& surfaces, const LightImage& light,
                                      const SurfacePoint& point, int x, int y) {
  float best = std::numeric_limits<float>::infinity();
  const Eigen::Vector3f* found = &light.at(x, y);
  for (int v = y - 1; v <= y + 1; ++v)
    for (int u = x - 1; u <= x + 1; ++u) {
      if (!surfaces.contains(u, v) || surfaces.at(u, v).id != point.id) continue;
      const SurfacePoint& other = surfaces.at(u, v);
      const float unlike = std::abs(other.depth - point.depth) + 1 - other.normal.dot(point.normal);
      if (unlike < best) best = unlike, found = &light.at(u, v);
    }
  return *found;
}

/// Light leaving a surface, after a tone curve that keeps bright spots below white.
Eigen::Vector3f toned(const SurfacePoint& point, const Eigen::Vector3f& light, float exposure) {
  if (point.id == 0) return Eigen::Vector3f::Zero();
  const Eigen::Vector3f leaving = point.albedo.cwiseProduct(light) + point.emission;
  return (1 - (-exposure * leaving.array()).exp()).matrix();
}

}  // namespace

void list_fields(RenderConfig& config, ConfigFields& fields) {
  fields.add("light_samples", config.light_samples, 1, 64, "shadow rays a pixel and light");
  fields.add("ambient_samples", config.ambient_samples, 0, 64,
             "rays a pixel that look for surfaces hiding the ambient light");
  fields.add("ambient_reach_m", config.ambient_reach_m, 0.01f, 10.f,
             "how near a surface must be to hide ambient light, metres");
  fields.add("exposure", config.exposure, 0.01f, 100.f,
             "factor on the light before the tone curve");
}

struct Renderer::State {
  State(const SynthRoom& room, const RenderConfig& render_config)
      : config(render_config), tracer(room.objects), lighting(room, tracer.scene(), config) {}

  /// What the ray meets first: the room, or what moves in it.
  SurfacePoint trace(const PinholeCamera& camera, const Pose& pose, double u, double v,
                     bool with_color, const MovingThing& thing) const {
    SurfacePoint point = tracer.trace(camera, pose, u, v, with_color);
    if (thing.tracer == nullptr) return point;
    SurfacePoint moving =
        thing.tracer->trace(camera, thing.world_from_thing.inverse() * pose, u, v, with_color);
    if (moving.id == 0 || (point.id != 0 && point.depth <= moving.depth)) return point;
    const Eigen::Isometry3f world_from_thing = thing.world_from_thing.cast<float>();
    moving.position = world_from_thing * moving.position;
    moving.face_normal = world_from_thing.linear() * moving.face_normal;
    moving.normal = world_from_thing.linear() * moving.normal;
    return moving;
  }

  Image<SurfacePoint> trace(const PinholeCamera& camera, const Pose& pose, bool with_color,
                            const MovingThing& thing) const {
    Image<SurfacePoint> surfaces(camera.width, camera.height);
    for_each_pixel(camera.width, camera.height, [&](int x, int y) {
      surfaces.at(x, y) = trace(camera, pose, x, y, with_color, thing);
    });
    return surfaces;
  }

  /// Linear light after the tone curve.
  Image<Eigen::Vector3f> draw(const PinholeCamera& camera, const Pose& pose,
                              const Image<SurfacePoint>& surfaces, float exposure,
                              const MovingThing& thing) const {
    const LightImage light = lighting.gather(surfaces);
    Image<Eigen::Vector3f> picture(camera.width, camera.height, Eigen::Vector3f::Zero());
    for_each_pixel(camera.width, camera.height, [&](int x, int y) {
      if (!on_edge(surfaces, x, y)) {
        picture.at(x, y) = toned(surfaces.at(x, y), light.at(x, y), exposure);
        return;
      }
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      for (const auto& [dx, dy] : kSubPixels) {
        const SurfacePoint point = trace(camera, pose, x + dx, y + dy, true, thing);
        sum += toned(point, borrowed_light(surfaces, light, point, x, y), exposure);
      }
      picture.at(x, y) = sum / kSubPixels.size();
    });
    return picture;
  }

  RenderConfig config;
  SurfaceTracer tracer;
  Lighting lighting;
};

Renderer::Renderer(const SynthRoom& room, const RenderConfig& config)
    : state_(std::make_unique<State>(room, config)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

namespace {

RgbImage encoded(const Image<Eigen::Vector3f>& picture) {
  RgbImage color(picture.width(), picture.height());
  for_each_pixel(picture.width(), picture.height(),
                 [&](int x, int y) { color.at(x, y) = srgb_from_linear(picture.at(x, y)); });
  return color;
}

RenderedView view_of(const Image<SurfacePoint>& surfaces) {
  RenderedView view;
  view.depth = DepthImage(surfaces.width(), surfaces.height());
  view.ids = IdImage(surfaces.width(), surfaces.height());
  view.incidence_cos = Image<float>(surfaces.width(), surfaces.height());
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    view.depth[i] = surfaces[i].depth;
    view.ids[i] = surfaces[i].id;
    view.incidence_cos[i] = surfaces[i].incidence_cos;
  }
  return view;
}

}  // namespace

RenderedView Renderer::render(const PinholeCamera& camera, const Pose& world_from_camera,
                              bool with_color, const MovingThing& thing) const {
  if (with_color) return render(camera, world_from_camera, Shutter{}, thing);
  return view_of(state_->trace(camera, world_from_camera, false, thing));
}

RenderedView Renderer::render(const PinholeCamera& camera, const Pose& world_from_camera,
                              const Shutter& shutter, const MovingThing& thing) const {
  const Image<SurfacePoint> surfaces = state_->trace(camera, world_from_camera, true, thing);
  const float exposure = state_->config.exposure * shutter.exposure;
  RenderedView view = view_of(surfaces);
  view.color = encoded(blurred(state_->draw(camera, world_from_camera, surfaces, exposure, thing),
                               view.depth, camera, world_from_camera, shutter.poses));
  return view;
}

const RayScene& Renderer::scene() const {
  return state_->tracer.scene();
}

}  // namespace ovimap
