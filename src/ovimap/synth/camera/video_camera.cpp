// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/camera/video_camera.h"

#include <algorithm>
#include <cmath>

#include "ovimap/base/config.h"
#include "ovimap/synth/shapes/texture.h"

namespace ovimap {
namespace {

constexpr double kMeterSpacing_s = 0.1;
constexpr int kMeterWidth_px = 32;
constexpr float kNearThing_m = 1;  // whose motion across the picture is estimated
constexpr int kBisections = 20;
constexpr float kWhite = 254.5f / 255;  // the light of white pixels is at least this one's

PinholeCamera scaled(const PinholeCamera& camera, int width) {
  const float scale = static_cast<float>(width) / static_cast<float>(camera.width);
  PinholeCamera small = camera;
  small.width = width;
  small.height = std::max(1, static_cast<int>(scale * static_cast<float>(camera.height)));
  small.fx *= scale, small.fy *= scale;
  small.cx = scale * (camera.cx + 0.5f) - 0.5f, small.cy = scale * (camera.cy + 0.5f) - 0.5f;
  return small;
}

/// Light before the tone curve 1 - exp(-light).
std::vector<float> light_in(const RgbImage& color) {
  std::vector<float> light;
  for (const Rgb8& pixel : color) {
    const float luminance = 0.2126f * linear_from_srgb(pixel.r) +
                            0.7152f * linear_from_srgb(pixel.g) +
                            0.0722f * linear_from_srgb(pixel.b);
    light.push_back(-std::log(1 - std::min(luminance, kWhite)));
  }
  return light;
}

/// The factor that brings the mean of the toned picture to the wanted brightness.
float wanted_exposure(const std::vector<float>& light, const VideoCameraConfig& config) {
  float low = std::log(config.least_exposure), high = std::log(config.most_exposure);
  for (int i = 0; i < kBisections; ++i) {
    const float middle = (low + high) / 2;
    float sum = 0;
    for (const float value : light) sum += 1 - std::exp(-std::exp(middle) * value);
    (sum < config.brightness * static_cast<float>(light.size()) ? low : high) = middle;
  }
  return (low + high) / 2;
}

}  // namespace

void list_fields(VideoCameraConfig& config, ConfigFields& fields) {
  fields.add("shutter_s", config.shutter_s, 0.f, 1.f,
             "how long the shutter is open, seconds; 0: no motion blur");
  fields.add("max_subframes", config.max_subframes, 1, 64, "pictures averaged for one frame");
  fields.add("still_px", config.still_px, 0.f, 10.f,
             "what moves less across the picture is sharp, pixels");
  fields.add("auto_exposure", config.auto_exposure, "whether the exposure follows the light");
  fields.add("brightness", config.brightness, 0.01f, 0.9f,
             "mean of the linear picture that the exposure aims at");
  fields.add("response_s", config.response_s, 0.001f, 100.f,
             "time constant with which the exposure follows, seconds");
  fields.add("least_exposure", config.least_exposure, 0.01f, 100.f, "smallest exposure factor");
  fields.add("most_exposure", config.most_exposure, 0.01f, 100.f, "largest exposure factor");
}

std::vector<Pose> shutter_poses(const Walk& walk, const PinholeCamera& camera, double time_s,
                                const VideoCameraConfig& config) {
  const double open_s = time_s - config.shutter_s / 2;
  const Pose motion = walk.at(open_s).inverse() * walk.at(open_s + config.shutter_s);
  const double turn_rad = Eigen::AngleAxisd(Eigen::Matrix3d(motion.linear())).angle();
  const double moved_px = camera.fx * (turn_rad + motion.translation().norm() / kNearThing_m);
  if (moved_px <= config.still_px) return {};
  const int count = std::clamp(static_cast<int>(std::ceil(moved_px)) + 1, 2, config.max_subframes);
  std::vector<Pose> poses;
  for (int i = 0; i < count; ++i)
    poses.push_back(walk.at(open_s + config.shutter_s * (i + 0.5) / count));
  return poses;
}

AutoExposure::AutoExposure(const Renderer& renderer, const PinholeCamera& camera, const Walk& walk,
                           const VideoCameraConfig& config) {
  const PinholeCamera meter = scaled(camera, kMeterWidth_px);
  const auto share =
      static_cast<float>(1 - std::exp(-kMeterSpacing_s / static_cast<double>(config.response_s)));
  float follows = 0;  // logarithm of the factor
  for (int i = 0; i * kMeterSpacing_s < walk.seconds() + kMeterSpacing_s; ++i) {
    const RenderedView view = renderer.render(meter, walk.at(i * kMeterSpacing_s));
    const float wanted = wanted_exposure(light_in(view.color), config);
    follows = i == 0 ? wanted : follows + share * (wanted - follows);
    factors_.push_back(std::exp(follows));
  }
}

float AutoExposure::at(double time_s) const {
  const double place =
      std::clamp(time_s / kMeterSpacing_s, 0., static_cast<double>(factors_.size() - 1));
  const auto i = std::min(static_cast<std::size_t>(place), factors_.size() - 1);
  const auto next = std::min(i + 1, factors_.size() - 1);
  const auto t = static_cast<float>(place - static_cast<double>(i));
  return factors_[i] + t * (factors_[next] - factors_[i]);
}

}  // namespace ovimap
