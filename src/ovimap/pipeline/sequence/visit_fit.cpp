// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/sequence/visit_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "ovimap/base/config.h"
#include "ovimap/base/error.h"

namespace ovimap {

namespace {

constexpr float kSearched_m = 0.2f;  // the given pose says no more than that
constexpr float kSearched_rad = 0.2f;

double share_of(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5)];
}

std::optional<Alignment> align_to_map(const Frame& frame, const VoxelMap& map,
                                      const TrackConfig& track, const VisitFitConfig& config) {
  const TrackPyramid pyramid = make_pyramid(frame);
  const Image<float> model = cast_inverse_depth(map, pyramid[kSurfaceLevel].camera,
                                                frame.world_from_camera, track.max_range_m);
  TrackPyramid known = {pyramid[0], pyramid[kSurfaceLevel]};
  if (keep_what_map_has(model, known[kSurfaceLevel]) < static_cast<double>(config.least_share))
    return std::nullopt;
  known[0].inverse_depth.fill(0.f);
  add_coarser_levels(known);
  FrameAlignmentConfig by_depth = track.alignment;
  by_depth.photometric_weight = 0;
  by_depth.prior_sigma_m = kSearched_m;
  by_depth.prior_sigma_rad = kSearched_rad;
  const Reference reference = make_reference(known, model, frame.world_from_camera);
  return align(reference, known, Pose::Identity(), by_depth, kSurfaceLevel);
}

}  // namespace

void list_fields(VisitFitConfig& config, ConfigFields& fields) {
  fields.add("enabled", config.enabled,
             "whether a recording is held against the map that it goes on with");
  fields.add("frames", config.frames, 1, 10000, "frames of it that are, evenly spread");
  fields.add("least_share", config.least_share, 0.f, 1.f,
             "a frame counts when this share of it shows surface of the map");
  fields.add("most_offset_m", config.most_offset_m, 0.f, 10.f,
             "how far off three quarters of those may lie, metres");
  fields.add("most_turn_rad", config.most_turn_rad, 0.f, 3.f, "likewise, radians");
  fields.add("least_agreement", config.least_agreement, 0.f, 1.f,
             "share of what they see that must lie on the map's surface");
  fields.add("object_frames", config.object_frames, 0, 100000,
             "first frames that are mapped by themselves to find their place by objects; 0: none");
  fields.group("alignment", [&](ConfigFields& f) { list_fields(config.alignment, f); });
  fields.group("past", [&](ConfigFields& f) { list_fields(config.past, f); });
}

void VisitFitter::add(const Frame& frame) {
  if (!frame.posed) return;
  const auto alignment = align_to_map(frame, map_, track_, config_);
  if (!alignment) return;
  given_.push_back(frame.world_from_camera);
  moves_.push_back(frame.world_from_camera * alignment->reference_from_frame *
                   frame.world_from_camera.inverse());
  offsets_m_.push_back(alignment->reference_from_frame.translation().norm());
  turns_rad_.push_back(Eigen::AngleAxisd(alignment->reference_from_frame.linear()).angle());
  agreements_.push_back(alignment->quality.agreement);
}

VisitFit VisitFitter::fit() const {
  return {static_cast<int>(offsets_m_.size()), share_of(offsets_m_, 0.75),
          share_of(turns_rad_, 0.75), share_of(agreements_, 0.5), middle_motion(given_, moves_)};
}

Pose middle_motion(const std::vector<Pose>& world_from_camera, const std::vector<Pose>& moves) {
  constexpr std::size_t kMostCameras = 16;
  std::vector<Eigen::Vector3d> points;
  const std::size_t step = 1 + world_from_camera.size() / kMostCameras;
  for (std::size_t i = 0; i < world_from_camera.size(); i += step)
    for (const Eigen::Vector3d& seen : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0, 0, 1)})
      points.push_back(world_from_camera[i] * seen);
  const auto difference = [&](const Pose& a, const Pose& b) {
    double sum_m = 0;
    for (const Eigen::Vector3d& point : points) sum_m += (a * point - b * point).norm();
    return sum_m;
  };
  Pose middle = Pose::Identity();
  double least_m = std::numeric_limits<double>::max();
  for (const Pose& move : moves) {
    double sum_m = 0;
    for (const Pose& other : moves) sum_m += difference(move, other);
    if (sum_m < least_m) least_m = sum_m, middle = move;
  }
  return middle;
}

VisitFit fit_visit(const VoxelMap& map, const FrameSource& source,
                   const std::vector<std::int64_t>& positions, const TrackConfig& track,
                   const VisitFitConfig& config) {
  VisitFitter fitter(map, track, config);
  const std::size_t count = std::min(positions.size(), static_cast<std::size_t>(config.frames));
  for (std::size_t i = 0; i < count; ++i) {
    const FrameRead read = source.read(positions[(2 * i + 1) * positions.size() / (2 * count)]);
    if (read.frame) fitter.add(*read.frame);
  }
  return fitter.fit();
}

std::string misfit(const VisitFit& fit, const VisitFitConfig& config) {
  if (fit.compared == 0) return "none of its frames that were looked at shows a place of the map";
  const double degrees = fit.turn_rad * 180 / std::numbers::pi;
  const auto rounded = [](double value, double step) { return std::round(value / step) * step; };
  if (fit.agreement < static_cast<double>(config.least_agreement))
    return concat("only ", std::lround(100 * fit.agreement),
                  " % of what its frames see lies on the map's surface");
  if (fit.offset_m > static_cast<double>(config.most_offset_m) ||
      fit.turn_rad > static_cast<double>(config.most_turn_rad))
    return concat("its poses are ", rounded(100 * fit.offset_m, 0.1), " cm and ",
                  rounded(degrees, 0.1), " degrees off");
  return {};
}

}  // namespace ovimap
