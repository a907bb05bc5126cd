// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "ovimap/geometry/camera.h"
#include "ovimap/geometry/pose.h"
#include "ovimap/image/image.h"
#include "ovimap/synth/render/ray_scene.h"
#include "ovimap/synth/render/surface_tracer.h"
#include "ovimap/synth/rooms/room.h"

namespace ovimap {

class ConfigFields;

struct RenderConfig {
  int light_samples = 1;    ///< shadow rays a pixel and light
  int ambient_samples = 2;  ///< rays a pixel that look for nearby surfaces hiding the ambient light
  float ambient_reach_m = 0.7f;  ///< how near a surface must be to hide ambient light
  float exposure = 1.f;          ///< factor on the light before the tone curve
};
void list_fields(RenderConfig& config, ConfigFields& fields);

/// What moves in a room: its surfaces in a frame of its own, and where that is. It is lit as if it
/// threw no shadow.
struct MovingThing {
  const SurfaceTracer* tracer = nullptr;  ///< null: nothing
  Pose world_from_thing = Pose::Identity();
};

/// How the colour image is taken.
struct Shutter {
  std::vector<Pose> poses;  ///< world_from_camera while it is open: their pictures are averaged;
                            ///< empty: one sharp picture
  float exposure = 1;       ///< factor on RenderConfig::exposure
};

/// What a camera without noise sees. All images have the camera's size.
struct RenderedView {
  RgbImage color;    ///< empty when it was not asked for
  DepthImage depth;  ///< exact, along the optical axis, metres; 0 where a ray leaves the room
  IdImage ids;       ///< RoomObject::id of the same ray; 0 where it leaves the room
  Image<float> incidence_cos;  ///< between the ray and the surface's normal, 0 (grazing) to 1
};

/// Draws a room: one ray a pixel for depth and ids, diffuse light of the room's lamps with shadows,
/// ambient light dimmed in corners. Edges of objects are smoothed in the colour image only. The
/// result does not depend on the number of threads.
class Renderer {
 public:
  /// `room` must outlive the renderer.
  Renderer(const SynthRoom& room, const RenderConfig& config = {});
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  RenderedView render(const PinholeCamera& camera, const Pose& world_from_camera,
                      bool with_color = true, const MovingThing& thing = {}) const;
  /// Depth and ids at the pose, colour as the shutter lets it in (see motion_blur.h).
  RenderedView render(const PinholeCamera& camera, const Pose& world_from_camera,
                      const Shutter& shutter, const MovingThing& thing = {}) const;

  const RayScene& scene() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace ovimap
