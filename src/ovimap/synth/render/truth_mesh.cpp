// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/render/truth_mesh.h"

#include <algorithm>
#include <cmath>

#include <tsl/robin_map.h>
#include <Eigen/Geometry>

#include "ovimap/base/config.h"
#include "ovimap/base/parallel.h"
#include "ovimap/synth/shapes/random.h"

namespace ovimap {
namespace {

constexpr std::size_t kVerticesPerTask = 1024;
constexpr std::uint32_t kDropped = ~0u;

struct Corner {
  Eigen::Vector3f position, normal;
  Eigen::Vector2f uv;
};

Corner between(const Corner& a, const Corner& b) {
  return {(a.position + b.position) / 2, (a.normal + b.normal) / 2, (a.uv + b.uv) / 2};
}

/// Gathers small triangles into a mesh whose vertices are at least about a cell apart.
class Gatherer {
 public:
  Gatherer(const TruthMeshConfig& config) : config_(config) {}

  void add_object(const RoomObject& object) {
    cells_.clear();
    object_ = &object;
    for (std::size_t i = 0; i < object.mesh.triangles.size(); ++i) {
      material_ = &object.mesh.materials[object.mesh.triangle_materials[i]];
      const auto& [a, b, c] = object.mesh.triangles[i];
      split(corner(a), corner(b), corner(c));
    }
  }

  Mesh take() { return std::move(mesh_); }

 private:
  Corner corner(std::uint32_t i) const {
    return {object_->mesh.vertices[i], object_->mesh.normals[i], object_->mesh.uvs[i]};
  }

  /// Halves the longest edge until all are short. An edge is cut into equal parts whose number
  /// depends on its length alone, so that neighbouring triangles stay joined.
  void split(const Corner& a, const Corner& b, const Corner& c) {
    const float ab = (a.position - b.position).norm(), bc = (b.position - c.position).norm(),
                ca = (c.position - a.position).norm();
    const float longest = std::max({ab, bc, ca});
    if (longest <= config_.longest_edge_m) {
      add_triangle(a, b, c);
    } else if (longest == ab) {
      const Corner middle = between(a, b);
      split(a, middle, c);
      split(middle, b, c);
    } else if (longest == bc) {
      const Corner middle = between(b, c);
      split(b, middle, a);
      split(middle, c, a);
    } else {
      const Corner middle = between(c, a);
      split(c, middle, b);
      split(middle, a, b);
    }
  }

  void add_triangle(const Corner& a, const Corner& b, const Corner& c) {
    const std::array<std::uint32_t, 3> triangle = {vertex(a), vertex(b), vertex(c)};
    if (triangle[0] != triangle[1] && triangle[1] != triangle[2] && triangle[2] != triangle[0])
      mesh_.triangles.push_back(triangle);
  }

  std::uint32_t vertex(const Corner& corner) {
    std::uint64_t key = 0;
    for (int i = 0; i < 3; ++i) {
      const auto cell =
          static_cast<std::int64_t>(std::floor(corner.position[i] / config_.merge_cell_m));
      key = (key << 21) | (static_cast<std::uint64_t>(cell) & 0x1fffff);
    }
    // Mixed, because the map takes the low bits of a key and those of packed coordinates are alike.
    const auto [found, is_new] =
        cells_.try_emplace(mix_bits(key), static_cast<std::uint32_t>(mesh_.vertices.size()));
    if (!is_new) return found->second;
    Eigen::Vector3f albedo = material_->albedo;
    if (material_->texture) albedo = material_->texture->sample(corner.uv, 1);
    const Rgb8 color = srgb_from_linear(albedo);
    mesh_.vertices.push_back(corner.position);
    mesh_.normals.push_back(corner.normal.normalized());
    mesh_.colors.push_back({color.r, color.g, color.b});
    mesh_.labels.push_back(object_->id);
    return found->second;
  }

  const TruthMeshConfig& config_;
  const RoomObject* object_ = nullptr;
  const SurfaceMaterial* material_ = nullptr;
  tsl::robin_map<std::uint64_t, std::uint32_t> cells_;
  Mesh mesh_;
};

/// A camera at one moment.
struct Lookout {
  Pose camera_from_world;
  Eigen::Vector3f eye;  ///< world, metres
};

/// What part of a mesh is seen from somewhere.
class Witnesses {
 public:
  Witnesses(const RayScene& scene, const PinholeCamera& camera,
            std::span<const Pose> world_from_camera, float leave_surface_m)
      : scene_(scene), camera_(camera), leave_surface_m_(leave_surface_m) {
    for (const Pose& pose : world_from_camera)
      lookouts_.push_back({pose.inverse(), pose.translation().cast<float>()});
  }

  /// Whether each of the points is seen. Who saw one is asked first about the next.
  void ask(std::span<const Eigen::Vector3f> points, std::uint8_t* seen) const {
    Eigen::AlignedBox3f box;
    for (const Eigen::Vector3f& point : points) box.extend(point);
    std::vector<const Lookout*> near;
    for (const Lookout& lookout : lookouts_)
      if (box.exteriorDistance(lookout.eye) < kFarthestSeen_m) near.push_back(&lookout);
    for (const Eigen::Vector3f& point : points) {
      const auto witness = std::find_if(
          near.begin(), near.end(), [&](const Lookout* lookout) { return sees(*lookout, point); });
      *seen++ = witness != near.end();
      if (witness != near.end()) std::iter_swap(witness, near.begin());
    }
  }

 private:
  bool sees(const Lookout& lookout, const Eigen::Vector3f& point) const {
    const Eigen::Vector3d in_camera = lookout.camera_from_world * point.cast<double>();
    if (in_camera.z() <= 0) return false;
    const Eigen::Vector2f pixel = camera_.project(in_camera.cast<float>());
    if (pixel.x() < -0.5f || pixel.y() < -0.5f ||
        pixel.x() > static_cast<float>(camera_.width) - 0.5f ||
        pixel.y() > static_cast<float>(camera_.height) - 0.5f)
      return false;
    const Eigen::Vector3f to_camera = lookout.eye - point;
    const float distance = to_camera.norm();
    if (distance <= leave_surface_m_ || distance > kFarthestSeen_m) return false;
    const Eigen::Vector3f direction = to_camera / distance;
    return !scene_.occluded(point + leave_surface_m_ * direction, direction,
                            distance - leave_surface_m_);
  }

  const RayScene& scene_;
  const PinholeCamera& camera_;
  float leave_surface_m_;
  std::vector<Lookout> lookouts_;
};

}  // namespace

void list_fields(TruthMeshConfig& config, ConfigFields& fields) {
  fields.add("longest_edge_m", config.longest_edge_m, 0.002f, 10.f,
             "longer edges are halved, metres");
  fields.add("merge_cell_m", config.merge_cell_m, 0.0005f, 1.f,
             "vertices of one instance in one cell of this size become one, metres");
  fields.add("leave_surface_m", config.leave_surface_m, 0.f, 0.1f,
             "how far before a vertex the line of sight may end, metres");
}

Mesh surface_mesh(const SynthRoom& room, const TruthMeshConfig& config) {
  Gatherer gatherer(config);
  for (const RoomObject& object : room.objects) gatherer.add_object(object);
  return gatherer.take();
}

Mesh seen_part(const Mesh& mesh, const RayScene& scene, const PinholeCamera& camera,
               std::span<const Pose> world_from_camera, const TruthMeshConfig& config) {
  std::vector<std::uint8_t> seen(mesh.vertices.size(), 0);
  const Witnesses witnesses(scene, camera, world_from_camera, config.leave_surface_m);
  parallel_for_ranges(
      mesh.vertices.size(), kVerticesPerTask, [&](std::size_t begin, std::size_t end) {
        witnesses.ask(std::span(mesh.vertices).subspan(begin, end - begin), seen.data() + begin);
      });
  Mesh part;
  std::vector<std::uint32_t> new_index(mesh.vertices.size(), kDropped);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    if (!seen[i]) continue;
    new_index[i] = static_cast<std::uint32_t>(part.vertices.size());
    part.vertices.push_back(mesh.vertices[i]);
    part.normals.push_back(mesh.normals[i]);
    part.colors.push_back(mesh.colors[i]);
    part.labels.push_back(mesh.labels[i]);
  }
  for (const auto& [a, b, c] : mesh.triangles)
    if (seen[a] && seen[b] && seen[c])
      part.triangles.push_back({new_index[a], new_index[b], new_index[c]});
  return part;
}

}  // namespace ovimap
