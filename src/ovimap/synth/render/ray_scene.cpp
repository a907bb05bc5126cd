// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/render/ray_scene.h"

#include <cmath>
#include <limits>

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
#include <Eigen/Geometry>

#include "ovimap/base/parallel.h"

namespace ovimap {
namespace {

// Where a sliver's own plane disagrees with Embree by more than this, its plane is not to be
// trusted.
constexpr double kPlaneAgreement = 1e-3;

void add_object(RTCDevice device, RTCScene scene, const TexturedMesh& mesh) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                               RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                                               mesh.vertices.size()));
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    for (int axis = 0; axis < 3; ++axis) *vertices++ = vertex[axis];
  auto* indices = static_cast<unsigned*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              3 * sizeof(unsigned), mesh.triangles.size()));
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t index : triangle) *indices++ = index;
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);  // ids count up from 0: the object's index
  rtcReleaseGeometry(geometry);
}

// Embree 3 wants a context with every ray, of which nothing is used here.
#if RTC_VERSION_MAJOR >= 4
void intersect(RTCScene scene, RTCRayHit& query) {
  rtcIntersect1(scene, &query);
}
void occlude(RTCScene scene, RTCRay& ray) {
  rtcOccluded1(scene, &ray);
}
#else
void intersect(RTCScene scene, RTCRayHit& query) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, &query);
}
void occlude(RTCScene scene, RTCRay& ray) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene, &context, &ray);
}
#endif

void fill_ray(RTCRay& ray, const Eigen::Vector3f& origin, const Eigen::Vector3f& direction,
              float reach) {
  ray.org_x = origin.x(), ray.org_y = origin.y(), ray.org_z = origin.z();
  ray.dir_x = direction.x(), ray.dir_y = direction.y(), ray.dir_z = direction.z();
  ray.tnear = 0, ray.tfar = reach, ray.time = 0;
  ray.mask = ~0u, ray.id = 0, ray.flags = 0;
}

}  // namespace

struct RayScene::Handle {
  Handle() : device(rtcNewDevice(nullptr)), scene(rtcNewScene(device)) {}
  ~Handle() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
  RTCDevice device;
  RTCScene scene;
};

RayScene::RayScene(std::span<const RoomObject> objects)
    : objects_(objects), handle_(std::make_unique<Handle>()) {
  rtcSetSceneFlags(handle_->scene, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(handle_->scene, RTC_BUILD_QUALITY_HIGH);
  for (const RoomObject& object : objects_)
    add_object(handle_->device, handle_->scene, object.mesh);
  // Built by one thread the tree, and with it which of two coinciding surfaces wins, is always the
  // same. Embree's own option for that would hold the whole process to one thread.
  on_this_thread([this] { rtcJoinCommitScene(handle_->scene); });
}

RayScene::~RayScene() = default;
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;

std::optional<RayHit> RayScene::trace(const Eigen::Vector3d& origin,
                                      const Eigen::Vector3d& direction) const {
  RTCRayHit query{};
  fill_ray(query.ray, origin.cast<float>(), direction.cast<float>(),
           std::numeric_limits<float>::infinity());
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  intersect(handle_->scene, query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;

  RayHit hit;
  hit.object = query.hit.geomID;
  hit.triangle = query.hit.primID;
  hit.weights = {1 - query.hit.u - query.hit.v, query.hit.u, query.hit.v};
  const TexturedMesh& mesh = objects_[hit.object].mesh;
  const auto& corners = mesh.triangles[hit.triangle];
  const Eigen::Vector3d a = mesh.vertices[corners[0]].cast<double>();
  const Eigen::Vector3d b = mesh.vertices[corners[1]].cast<double>();
  const Eigen::Vector3d c = mesh.vertices[corners[2]].cast<double>();
  const Eigen::Vector3d normal = (b - a).cross(c - a).normalized();
  const double slope = normal.dot(direction);
  hit.distance = normal.dot(a - origin) / slope;
  if (!(std::abs(hit.distance - query.ray.tfar) < kPlaneAgreement)) hit.distance = query.ray.tfar;
  hit.normal = (slope > 0 ? Eigen::Vector3d(-normal) : normal).cast<float>();
  return hit;
}

bool RayScene::occluded(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction,
                        float reach) const {
  RTCRay ray{};
  fill_ray(ray, origin, direction, reach);
  occlude(handle_->scene, ray);
  return ray.tfar < 0;
}

}  // namespace ovimap
