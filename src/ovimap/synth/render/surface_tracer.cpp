// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/render/surface_tracer.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace ovimap {
namespace {

// Interpolated normals that lean this far from their triangle come from faulty models.
constexpr float kLeastNormalAgreement = 0.3f;
// A texture seen at a slant is averaged along its longer direction only so far, or it would blur.
constexpr float kLeastSlant = 0.35f;

std::vector<float> texel_densities(const TexturedMesh& mesh) {
  std::vector<float> densities(mesh.triangles.size(), 0.f);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& texture = mesh.materials[mesh.triangle_materials[i]].texture;
    if (!texture) continue;
    const auto& [a, b, c] = mesh.triangles[i];
    const Eigen::Vector2f s = mesh.uvs[b] - mesh.uvs[a], t = mesh.uvs[c] - mesh.uvs[a];
    const float pixels = std::abs(s.x() * t.y() - s.y() * t.x()) *
                         static_cast<float>(texture->width()) *
                         static_cast<float>(texture->height());
    const float area =
        (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).norm();
    if (area > 0) densities[i] = std::sqrt(pixels / area);
  }
  return densities;
}

}  // namespace

SurfaceTracer::SurfaceTracer(std::span<const RoomObject> objects) : scene_(objects) {
  for (const RoomObject& object : objects) texel_density_.push_back(texel_densities(object.mesh));
}

SurfacePoint SurfaceTracer::trace(const PinholeCamera& camera, const Pose& world_from_camera,
                                  double u, double v, bool with_material) const {
  // The direction has length one along the optical axis, so that distance along it is depth.
  const Eigen::Vector3d direction =
      world_from_camera.linear() *
      Eigen::Vector3d((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1.0);
  const Eigen::Vector3d origin = world_from_camera.translation();
  const auto hit = scene_.trace(origin, direction);
  SurfacePoint point;
  if (!hit) return point;
  point.id = scene_.objects()[hit->object].id;
  point.depth = static_cast<float>(hit->distance);
  point.position = (origin + hit->distance * direction).cast<float>();
  point.face_normal = hit->normal;
  point.incidence_cos =
      std::abs(hit->normal.dot(direction.cast<float>())) / static_cast<float>(direction.norm());
  const float slant = std::max(point.incidence_cos, kLeastSlant);
  if (with_material) read_material(*hit, point.depth / camera.fx / slant, point);
  return point;
}

void SurfaceTracer::read_material(const RayHit& hit, float footprint_m, SurfacePoint& point) const {
  const TexturedMesh& mesh = scene_.objects()[hit.object].mesh;
  const auto& [a, b, c] = mesh.triangles[hit.triangle];
  const Eigen::Vector3f& w = hit.weights;
  point.normal = w[0] * mesh.normals[a] + w[1] * mesh.normals[b] + w[2] * mesh.normals[c];
  point.normal.normalize();
  float agreement = point.normal.dot(hit.normal);
  if (agreement < 0) point.normal = -point.normal, agreement = -agreement;
  if (!(agreement > kLeastNormalAgreement)) point.normal = hit.normal;

  const SurfaceMaterial& material = mesh.materials[mesh.triangle_materials[hit.triangle]];
  point.albedo = material.albedo;
  if (material.texture) {
    const Eigen::Vector2f uv = w[0] * mesh.uvs[a] + w[1] * mesh.uvs[b] + w[2] * mesh.uvs[c];
    point.albedo =
        material.texture->sample(uv, footprint_m * texel_density_[hit.object][hit.triangle]);
  }
  point.emission = material.emission.cwiseProduct(point.albedo);
}

}  // namespace ovimap
