// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/approach/approach.h"

#include <algorithm>
#include <cmath>

#include "ovimap/base/config.h"
#include "ovimap/base/error.h"
#include "ovimap/base/parallel.h"
#include "ovimap/pipeline/approach/ground_ways.h"

namespace ovimap {

namespace {

constexpr float kRadians = static_cast<float>(M_PI) / 180.f;
constexpr float kLeastFacing = 0.17f;  // cosine: what is seen at more than 80 degrees is no view

/// A place to stand, and what is seen from there.
struct Candidate {
  Eigen::Vector2i cell;
  std::vector<bool> sees;  ///< [samples]
  float facing = 0;        ///< sum of the cosines at what it sees
  float seen = 0;          ///< share of the visible surface
};

Eigen::Vector3f middle_of(const std::vector<SurfaceSample>& samples) {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (const SurfaceSample& sample : samples) sum += sample.point;
  return sum / static_cast<float>(samples.size());
}

/// Whether some sample lies within the range, as the floor is measured.
bool in_range(const std::vector<SurfaceSample>& samples, const Eigen::Vector2f& place,
              float range_m) {
  return std::any_of(samples.begin(), samples.end(), [&](const SurfaceSample& sample) {
    return (sample.point.head<2>() - place).squaredNorm() <= range_m * range_m;
  });
}

/// Passable cells near the object, on a lattice that is as wide as it must be for there to be few.
std::vector<Candidate> candidates_near(const PassableCells& cells,
                                       const std::vector<SurfaceSample>& samples, float range_m) {
  constexpr std::size_t kMostCandidates = 256;
  Eigen::AlignedBox2f around;
  for (const SurfaceSample& sample : samples) around.extend(sample.point.head<2>().eval());
  around.min().array() -= range_m;
  around.max().array() += range_m;
  std::vector<Candidate> near;
  for (int y = 0; y < cells.height(); ++y)
    for (int x = 0; x < cells.width(); ++x) {
      const Eigen::Vector2f place = cells.place_of({x, y});
      if (cells.at({x, y}) && around.contains(place) && in_range(samples, place, range_m))
        near.push_back({{x, y}, {}});
    }
  std::vector<Candidate> fewer = near;
  for (int spacing = 2; fewer.size() > kMostCandidates; ++spacing) {
    std::vector<Candidate> apart;
    for (const Candidate& candidate : near)
      if (candidate.cell.x() % spacing == 0 && candidate.cell.y() % spacing == 0)
        apart.push_back(candidate);
    if (apart.empty()) break;  // a passage that is narrower than that
    fewer = std::move(apart);
  }
  const std::size_t step = 1 + fewer.size() / (kMostCandidates + 1);
  if (step == 1) return fewer;
  std::vector<Candidate> few;
  for (std::size_t i = 0; i < fewer.size(); i += step) few.push_back(fewer[i]);
  return few;
}

/// What a camera over the candidate sees of the samples, turned to their middle.
void look(const StandingSpace& space, const std::vector<SurfaceSample>& samples,
          const Eigen::Vector3f& eye, const ApproachConfig& config, Candidate& candidate) {
  const Eigen::Vector3f axis = (middle_of(samples) - eye).normalized();
  const float least_cosine = std::cos(0.5f * config.fov_deg * kRadians);
  candidate.sees.assign(samples.size(), false);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Eigen::Vector3f ray = (samples[i].point - eye).normalized();
    const float facing = -ray.dot(samples[i].normal);
    if (facing < kLeastFacing || ray.dot(axis) < least_cosine) continue;
    if (!space.sight.clear(eye, samples[i].point)) continue;
    candidate.sees[i] = true;
    candidate.facing += facing;
  }
}

Eigen::Vector3f eye_over(const StandingSpace& space, const Eigen::Vector2f& place,
                         const ApproachConfig& config) {
  return {place.x(), place.y(), space.grid.floor_m + config.camera_height_m};
}

/// Looks from all candidates. The share that each sees is of what any of them sees.
void look_from_all(const StandingSpace& space, const std::vector<SurfaceSample>& samples,
                   const PassableCells& cells, const ApproachConfig& config,
                   std::vector<Candidate>& candidates) {
  parallel_for(candidates.size(), 8, [&](std::size_t i) {
    look(space, samples, eye_over(space, cells.place_of(candidates[i].cell), config), config,
         candidates[i]);
  });
  std::vector<bool> visible(samples.size(), false);
  for (const Candidate& candidate : candidates)
    for (std::size_t i = 0; i < samples.size(); ++i)
      if (candidate.sees[i]) visible[i] = true;
  const auto all = static_cast<float>(std::count(visible.begin(), visible.end(), true));
  for (Candidate& candidate : candidates)
    candidate.seen =
        static_cast<float>(std::count(candidate.sees.begin(), candidate.sees.end(), true)) /
        std::max(all, 1.f);
}

/// Best first: good views by the length of the way to them, then the others by how good they are.
void order(std::vector<Candidate>& candidates, const GroundWays& ways, bool by_way,
           const ApproachConfig& config) {
  float best = 0.f;
  for (const Candidate& candidate : candidates) best = std::max(best, candidate.facing);
  const auto cost = [&](const Candidate& candidate) {
    const bool good = candidate.facing >= config.good_share * best;
    return std::pair(!good, good && by_way ? ways.length_m(candidate.cell) : -candidate.facing);
  };
  std::stable_sort(candidates.begin(), candidates.end(),
                   [&](const Candidate& a, const Candidate& b) { return cost(a) < cost(b); });
}

ApproachPose pose_of(const StandingSpace& space, const std::vector<SurfaceSample>& samples,
                     const PassableCells& cells, const Candidate& candidate,
                     const ApproachConfig& config) {
  ApproachPose pose;
  pose.place_m = cells.place_of(candidate.cell);
  const Eigen::Vector3f gaze = middle_of(samples) - eye_over(space, pose.place_m, config);
  pose.yaw_rad = std::atan2(gaze.y(), gaze.x());
  pose.tilt_rad = std::atan2(gaze.z(), gaze.head<2>().norm());
  pose.seen = candidate.seen;
  pose.distance_m = gaze.norm();
  return pose;
}

/// The first of the ordered candidates that are a robot's width from those taken before.
std::vector<ApproachPose> chosen_poses(const StandingSpace& space,
                                       const std::vector<SurfaceSample>& samples,
                                       const PassableCells& cells,
                                       const std::vector<Candidate>& candidates,
                                       const GroundWays& ways, bool with_way,
                                       const ApproachConfig& config) {
  std::vector<ApproachPose> poses;
  for (const Candidate& candidate : candidates) {
    if (poses.size() == static_cast<std::size_t>(config.poses)) break;
    ApproachPose pose = pose_of(space, samples, cells, candidate, config);
    const bool apart = std::all_of(poses.begin(), poses.end(), [&](const ApproachPose& other) {
      return (other.place_m - pose.place_m).norm() >= 2 * config.radius_m;
    });
    if (!apart) continue;
    if (with_way) {
      pose.way = ways.way_to(candidate.cell);
      for (std::size_t i = 1; i < pose.way.size(); ++i)
        pose.way_m += (pose.way[i] - pose.way[i - 1]).norm();
    }
    poses.push_back(std::move(pose));
  }
  return poses;
}

std::string percent(float share) {
  return concat(std::lround(100.f * share), " %");
}

/// "(1.2, 3.4)".
std::string text_of(const Eigen::Vector2f& place) {
  return concat("(", place.x(), ", ", place.y(), ")");
}

Approach none(std::string reason) {
  return {{}, std::move(reason)};
}

}  // namespace

void list_fields(ApproachConfig& config, ConfigFields& fields) {
  fields.add("radius_m", config.radius_m, 0.01f, 10.f, "of the robot");
  fields.add("camera_height_m", config.camera_height_m, 0.05f, 10.f,
             "above the floor; the robot is taken to be as high");
  fields.add("fov_deg", config.fov_deg, 1.f, 180.f, "of the camera, a cone");
  fields.add("range_m", config.range_m, 0.05f, 20.f,
             "from the object to the robot's middle, as the floor is measured");
  fields.add("least_seen", config.least_seen, 0.01f, 1.f, "of the object's visible surface");
  fields.add("good_share", config.good_share, 0.f, 1.f,
             "of the best view: such views go by the length of the way");
  fields.add("poses", config.poses, 1, 100, "at most so many");
  fields.add("low_m", config.low_m, 0.f, 1.f, "lower things can be driven over");
}

Approach find_approach(const StandingSpace& space, InstanceId object, const ApproachConfig& config,
                       const std::optional<Eigen::Vector2f>& from) {
  const auto surface = space.surfaces.find(object);
  if (surface == space.surfaces.end())
    return none(concat("#", object, " has no surface in the map"));
  const std::vector<SurfaceSample>& samples = surface->second;
  const PassableCells cells(
      band_of(space.grid, config.low_m, config.camera_height_m, OccupancyConfig{}),
      config.radius_m);
  const std::optional<Eigen::Vector2i> start =
      from ? cells.nearest(*from, 2 * config.radius_m) : cells.in_largest_part();
  if (!start && from)
    return none(concat("the robot cannot be at ", text_of(*from),
                       ": no free place for a radius of ", config.radius_m, " m there"));
  std::vector<Candidate> candidates = candidates_near(cells, samples, config.range_m);
  if (candidates.empty())
    return none(concat("no free place for a radius of ", config.radius_m, " m within ",
                       config.range_m, " m of #", object));
  look_from_all(space, samples, cells, config, candidates);
  float most = 0.f;
  for (const Candidate& candidate : candidates) most = std::max(most, candidate.seen);
  std::erase_if(candidates, [&](const Candidate& c) { return c.seen < config.least_seen; });
  if (candidates.empty())
    return none(most == 0.f ? concat("something hides #", object, " from every free place near it")
                            : concat("no more than ", percent(most), " of #", object,
                                     " can be seen from one free place near it"));
  const GroundWays ways(cells, *start);
  std::erase_if(candidates, [&](const Candidate& c) { return !ways.reaches(c.cell); });
  if (candidates.empty())
    return none(concat("no way for a radius of ", config.radius_m, " m leads ",
                       from ? "from " + text_of(*from) : "from the largest free space",
                       " to where #", object, " can be seen"));
  order(candidates, ways, from.has_value(), config);
  return {chosen_poses(space, samples, cells, candidates, ways, from.has_value(), config), ""};
}

}  // namespace ovimap
