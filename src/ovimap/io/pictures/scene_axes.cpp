// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/pictures/scene_axes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "ovimap/base/config.h"

namespace ovimap {

namespace {

/// Normal times twice the area of each triangle.
std::vector<Eigen::Vector3f> area_normals(const Mesh& mesh) {
  std::vector<Eigen::Vector3f> normals;
  normals.reserve(mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles)
    normals.push_back(
        (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]));
  return normals;
}

constexpr int kCubeCells = 64;  // along an edge of the cube around all directions

/// The cell of a cube's side that a direction points to.
std::size_t cube_cell(const Eigen::Vector3f& direction) {
  Eigen::Index axis = 0;
  const float longest = direction.cwiseAbs().maxCoeff(&axis);
  const auto cell = [&](Eigen::Index along) {
    const float place = (direction[along % 3] / longest + 1) / 2;  // 0 to 1
    return std::min(kCubeCells - 1, static_cast<int>(place * kCubeCells));
  };
  const int side = 2 * static_cast<int>(axis) + (direction[axis] < 0);
  return static_cast<std::size_t>((side * kCubeCells + cell(axis + 1)) * kCubeCells +
                                  cell(axis + 2));
}

float cosine_of_degrees(float degrees) {
  return std::cos(degrees * std::numbers::pi_v<float> / 180);
}

std::pair<Eigen::Vector3f, Eigen::Vector3f> axes_across(const Eigen::Vector3f& direction) {
  const Eigen::Vector3f first = direction.unitOrthogonal();
  return {first, direction.cross(first)};
}

/// Horizontal axes that do not turn when `up` changes a little: the first is the next of the
/// world's axes after the one that is most upright.
std::pair<Eigen::Vector3f, Eigen::Vector3f> level_axes(const Eigen::Vector3f& up) {
  Eigen::Index upright = 0;
  up.cwiseAbs().maxCoeff(&upright);
  const Eigen::Vector3f axis = Eigen::Vector3f::Unit((upright + 1) % 3);
  const Eigen::Vector3f first = (axis - axis.dot(up) * up).normalized();
  return {first, up.cross(first)};
}

/// A map of directions around one of them: its plane, cut into square cells that collect area.
class DirectionHistogram {
 public:
  DirectionHistogram(const Eigen::Vector3f& center, float window_deg)
      : center_(center), axes_(axes_across(center)) {
    cells_ =
        std::max(1, static_cast<int>(2 / std::sin(window_deg * std::numbers::pi_v<float> / 180)));
    sums_.resize(static_cast<std::size_t>(cells_ * cells_), Eigen::Vector3d::Zero());
  }

  void add(const Eigen::Vector3f& area_normal) {
    const Eigen::Vector3f direction = area_normal.normalized();
    const auto cell = [this](float coordinate) {
      return std::clamp(static_cast<int>((coordinate + 1) / 2 * static_cast<float>(cells_)), 0,
                        cells_ - 1);
    };
    sums_[static_cast<std::size_t>(cell(direction.dot(axes_.second)) * cells_ +
                                   cell(direction.dot(axes_.first)))] += area_normal.cast<double>();
  }

  /// The mean direction of the fullest cell; the center when all are empty.
  Eigen::Vector3f fullest() const {
    const auto best = std::max_element(
        sums_.begin(), sums_.end(),
        [](const auto& a, const auto& b) { return a.squaredNorm() < b.squaredNorm(); });
    return best->squaredNorm() > 0 ? Eigen::Vector3f(best->normalized().cast<float>()) : center_;
  }

 private:
  Eigen::Vector3f center_;
  std::pair<Eigen::Vector3f, Eigen::Vector3f> axes_;
  int cells_ = 0;
  std::vector<Eigen::Vector3d> sums_;
};

Eigen::Vector3f mean_camera_up(std::span<const Pose> world_from_camera) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Pose& pose : world_from_camera) sum -= pose.linear().col(1);
  if (sum.norm() < 1e-6 * static_cast<double>(world_from_camera.size()) ||
      world_from_camera.empty())
    return Eigen::Vector3f::UnitZ();
  return sum.normalized().cast<float>();
}

constexpr float kUprightCosine = 0.3f;  // walls may lean that much
constexpr float kQuarterTurn = std::numbers::pi_v<float> / 2;
constexpr int kQuarterBins = 90;  // one degree each

/// The area that faces one degree of a quarter turn, and its area-weighted angle in degrees.
struct QuarterBin {
  double area = 0, moment = 0;
};

/// Where a cyclic histogram is fullest, in degrees: the mean of the best window around a bin.
double peak_of(const std::array<QuarterBin, kQuarterBins>& bins) {
  constexpr int kHalfWindow = 4;
  double best_area = 0, peak = 0;
  for (int center = 0; center < kQuarterBins; ++center) {
    QuarterBin sum;
    for (int at = center - kHalfWindow; at <= center + kHalfWindow; ++at) {
      const int wrapped = (at + kQuarterBins) % kQuarterBins;
      const QuarterBin& bin = bins[static_cast<std::size_t>(wrapped)];
      sum.area += bin.area;
      sum.moment += bin.moment + bin.area * (at - wrapped);
    }
    if (sum.area <= best_area) continue;
    best_area = sum.area;
    peak = sum.moment / sum.area;
  }
  return peak;
}

}  // namespace

void list_fields(SceneAxesConfig& config, ConfigFields& fields) {
  fields.add("cone_deg", config.cone_deg, 1.f, 89.f,
             "how far the floor's normal may be from the cameras' mean up, in degrees");
  fields.add("window_deg", config.window_deg, 1.f, 45.f,
             "normals within this angle count as one direction, in degrees");
}

SurfaceDirections::SurfaceDirections()
    : sums_(6 * kCubeCells * kCubeCells, Eigen::Vector3d::Zero()) {}

void SurfaceDirections::add(const Mesh& part) {
  for (const Eigen::Vector3f& normal : ovimap::area_normals(part))
    if (normal.squaredNorm() > 0) sums_[cube_cell(normal)] += normal.cast<double>();
}

const std::vector<Eigen::Vector3f>& SurfaceDirections::area_normals() {
  normals_.resize(sums_.size());
  std::transform(sums_.begin(), sums_.end(), normals_.begin(),
                 [](const Eigen::Vector3d& sum) { return sum.cast<float>().eval(); });
  return normals_;
}

namespace {

Eigen::Vector3f guess_up(const std::vector<Eigen::Vector3f>& normals,
                         std::span<const Pose> world_from_camera, const SceneAxesConfig& config) {
  const Eigen::Vector3f camera_up = mean_camera_up(world_from_camera);
  if (world_from_camera.empty()) return camera_up;
  const float in_cone = cosine_of_degrees(config.cone_deg),
              in_window = cosine_of_degrees(config.window_deg);
  DirectionHistogram histogram(camera_up, config.window_deg);
  for (const Eigen::Vector3f& normal : normals)
    if (normal.dot(camera_up) > in_cone * normal.norm()) histogram.add(normal);
  Eigen::Vector3f up = histogram.fullest();
  // A cell may cut the peak in two; the mean of the window around it, taken again, finds its
  // middle.
  constexpr int kRefinements = 5;
  for (int i = 0; i < kRefinements; ++i) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3f& normal : normals)
      if (normal.dot(up) > in_window * normal.norm()) sum += normal.cast<double>();
    if (sum.squaredNorm() > 0) up = sum.normalized().cast<float>();
  }
  return up;
}

}  // namespace

Eigen::Vector3f guess_up(const Mesh& mesh, std::span<const Pose> world_from_camera,
                         const SceneAxesConfig& config) {
  return guess_up(area_normals(mesh), world_from_camera, config);
}

Eigen::Vector3f guess_up(SurfaceDirections& directions, std::span<const Pose> world_from_camera,
                         const SceneAxesConfig& config) {
  return guess_up(directions.area_normals(), world_from_camera, config);
}

Eigen::Vector3f guess_wall_direction(SurfaceDirections& directions, const Eigen::Vector3f& up) {
  const auto [right, forward] = level_axes(up);
  std::array<QuarterBin, kQuarterBins> bins{};
  for (const Eigen::Vector3f& normal : directions.area_normals()) {
    const float area = normal.norm();
    if (std::abs(normal.dot(up)) >= kUprightCosine * area) continue;
    const float quarters = std::atan2(normal.dot(forward), normal.dot(right)) / kQuarterTurn;
    const float degrees = (quarters - std::floor(quarters)) * kQuarterBins;
    QuarterBin& bin = bins[static_cast<std::size_t>(degrees) % kQuarterBins];
    bin.area += area;
    bin.moment += static_cast<double>(area) * degrees;
  }
  float angle = static_cast<float>(peak_of(bins)) * kQuarterTurn / kQuarterBins;
  if (angle > kQuarterTurn / 2) angle -= kQuarterTurn;
  return std::cos(angle) * right + std::sin(angle) * forward;
}

}  // namespace ovimap
