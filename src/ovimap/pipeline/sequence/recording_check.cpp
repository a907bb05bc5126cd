// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/sequence/recording_check.h"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>

#include "ovimap/base/error.h"
#include "ovimap/base/median.h"
#include "ovimap/base/parallel.h"
#include "ovimap/segment/depth_surface.h"

namespace ovimap {

namespace {

constexpr std::array kDistances_m = {0.5f, 1.f, 2.f, 4.f, 8.f};
constexpr float kWithin = 1.5f;           // as far again and as near are told with a distance
constexpr float kLeastShare = 0.05f;      // of the depth in one frame
constexpr std::size_t kFewestPx = 20000;  // of depth, or the model would be told for the sensor
constexpr std::int64_t kMostFrames = 12;

using Errors = std::array<std::optional<DepthError>, kDistances_m.size()>;

/// Share of the valid depth that lies about a distance.
float share_at(const DepthImage& depth, float distance_m, std::size_t valid) {
  const auto there = std::count_if(depth.begin(), depth.end(), [&](float depth_m) {
    return depth_m > distance_m / kWithin && depth_m < distance_m * kWithin;
  });
  return static_cast<float>(there) / static_cast<float>(valid);
}

Errors errors_in(const Frame& frame, const DepthSurfaceConfig& config) {
  Errors errors;
  const auto valid = static_cast<std::size_t>(std::count_if(
      frame.depth.begin(), frame.depth.end(), [](float depth_m) { return depth_m > 0.f; }));
  if (valid < kFewestPx) return errors;
  const FrameNoise noise = fit_depth_surface(frame.depth, frame.depth_camera, config).noise;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const float distance_m = kDistances_m[i], sigma_m = config.noise.sigma_m(distance_m);
    if (share_at(frame.depth, distance_m, valid) < kLeastShare) continue;
    errors[i] = {distance_m, noise.pixel.at(distance_m) * sigma_m,
                 noise.plane.at(distance_m) * sigma_m};
  }
  return errors;
}

std::string millimetres(float length_m) {
  constexpr int kDigits = 3;
  char text[32];
  std::snprintf(text, sizeof text, "%.*g mm", kDigits, 1000.0 * double{length_m});
  return text;
}

/// Nothing is wrong with noise: mapping reads it off each frame as well.
Finding finding_of(const std::vector<DepthError>& errors) {
  std::string message = "a pixel's depth errs by";
  for (const DepthError& error : errors)
    message += concat(&error == &errors.front() ? " " : ", ", millimetres(error.pixel_m), " at ",
                      error.distance_m, " m (", millimetres(error.surface_m), ")");
  return {Severity::kOk, "noise", message + "; in brackets what averages leave of it", {}};
}

}  // namespace

std::vector<DepthError> measure_depth_errors(const FrameSource& source,
                                             const DepthSurfaceConfig& config) {
  const std::int64_t count = std::min(source.size(), kMostFrames);
  std::vector<Errors> frames(static_cast<std::size_t>(count));
  parallel_for(frames.size(), 1, [&](std::size_t i) {
    const FrameRead read = source.read(static_cast<std::int64_t>(i) * source.size() / count);
    if (read.frame) frames[i] = errors_in(*read.frame, config);
  });
  std::vector<DepthError> found;
  for (std::size_t i = 0; i < kDistances_m.size(); ++i) {
    std::vector<float> pixel, surface;
    for (const Errors& errors : frames)
      if (errors[i]) pixel.push_back(errors[i]->pixel_m), surface.push_back(errors[i]->surface_m);
    if (!pixel.empty()) found.push_back({kDistances_m[i], median_of(pixel), median_of(surface)});
  }
  return found;
}

CheckReport check_recording(const std::filesystem::path& path, const SourceCheckConfig& config,
                            const FrameRange& range) {
  FrameSourceConfig unlimited;
  unlimited.min_depth_m = 0;
  unlimited.max_depth_m = std::numeric_limits<float>::max();
  unlimited.poses = PoseNeed::kAllOrNone;
  const auto source = choose_frames(open_frame_source(path, unlimited), range);
  CheckReport report = check_source(*source, config);
  report.depth_errors = measure_depth_errors(*source, DepthSurfaceConfig{});
  if (!report.depth_errors.empty()) report.findings.push_back(finding_of(report.depth_errors));
  return report;
}

}  // namespace ovimap
