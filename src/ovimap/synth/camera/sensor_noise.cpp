// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/camera/sensor_noise.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "ovimap/base/config.h"
#include "ovimap/base/parallel.h"
#include "ovimap/synth/shapes/random.h"

namespace ovimap {
namespace {

constexpr std::size_t kNoisyRowsPerTask = 8;
enum NoiseStream : std::uint64_t {
  kDepthStream = 1ull << 40,
  kColorStream = 2ull << 40,
  kPoseStream = 3ull << 40,
  kWindowStream = 4ull << 40,
  kLensStream = 5ull << 40
};

constexpr std::uint64_t kLensSeed = 1;   // a camera keeps its lens
constexpr float kLensCellsAcross = 4.f;  // of the image's width

/// Whether depth jumps between the pixel and one of its eight neighbours.
bool on_depth_edge(const DepthImage& depth, int x, int y, float jump) {
  const float center = depth.at(x, y);
  for (int v = std::max(0, y - 1); v <= std::min(depth.height() - 1, y + 1); ++v)
    for (int u = std::max(0, x - 1); u <= std::min(depth.width() - 1, x + 1); ++u)
      if (std::abs(depth.at(u, v) - center) > jump * center) return true;
  return false;
}

/// Standard normal numbers that change smoothly over an image: those of a coarse grid, between its
/// points their bilinear mean brought back to a deviation of one.
class SmoothField {
 public:
  SmoothField(float cell_px, std::uint64_t seed, std::uint64_t stream)
      : cell_px_(cell_px), seed_(seed), stream_(stream) {}

  float at(int x, int y) const {
    const float gx = static_cast<float>(x) / cell_px_, gy = static_cast<float>(y) / cell_px_;
    const float left = std::floor(gx), top = std::floor(gy), fx = gx - left, fy = gy - top;
    float sum = 0, squares = 0;
    for (const int dy : {0, 1})
      for (const int dx : {0, 1}) {
        const float weight = (dx == 0 ? 1 - fx : fx) * (dy == 0 ? 1 - fy : fy);
        sum += weight * node(static_cast<int>(left) + dx, static_cast<int>(top) + dy);
        squares += weight * weight;
      }
    return sum / std::sqrt(squares);
  }

 private:
  float node(int x, int y) const {
    constexpr std::uint64_t kMostColumns = 1 << 16;
    return Random(seed_, stream_ + static_cast<std::uint64_t>(y) * kMostColumns +
                             static_cast<std::uint64_t>(x))
        .normal();
  }
  float cell_px_;
  std::uint64_t seed_, stream_;
};

/// What a pixel draws: of its own, or like its neighbours.
struct Draws {
  float shift_x, shift_y, depth;
};

/// The same numbers for the same pixel of a frame, and the lens of all frames.
class SensorErrors {
 public:
  SensorErrors(const SensorNoiseConfig& config, int width, std::uint64_t seed)
      : config_(config),
        shift_x_(config.correlation_px, seed, kWindowStream),
        shift_y_(config.correlation_px, seed, kWindowStream + (1ull << 36)),
        depth_(config.correlation_px, seed, kWindowStream + (2ull << 36)),
        lens_(static_cast<float>(width) / kLensCellsAcross, kLensSeed, kLensStream) {}

  Draws draw(int x, int y, Random& random) const {
    if (config_.correlation_px <= 0) return {random.normal(), random.normal(), random.normal()};
    return {shift_x_.at(x, y), shift_y_.at(x, y), depth_.at(x, y)};
  }
  float lens_bias_px(int x, int y) const {
    return config_.lens_bias_px > 0 ? config_.lens_bias_px * lens_.at(x, y) : 0.f;
  }

 private:
  const SensorNoiseConfig& config_;
  SmoothField shift_x_, shift_y_, depth_, lens_;
};

float measured(const RenderedView& view, const SensorNoiseConfig& config,
               const SensorErrors& errors, int x, int y, Random& random) {
  const auto shifted = [&](int position, float normal, int size) {
    const float shift = config.lateral_sigma_px * normal;
    return std::clamp(position + static_cast<int>(std::lround(shift)), 0, size - 1);
  };
  const Draws draws = errors.draw(x, y, random);
  const int u = shifted(x, draws.shift_x, view.depth.width()),
            v = shifted(y, draws.shift_y, view.depth.height());
  const float edge = random.uniform(), grazing = random.uniform();
  const float loss = random.uniform(), depth = view.depth.at(u, v);
  if (depth <= 0 || loss < config.random_loss) return 0;
  if (edge < config.edge_loss && on_depth_edge(view.depth, u, v, config.edge_jump)) return 0;
  const float answers = (view.incidence_cos.at(u, v) - config.grazing_end_cos) /
                        std::max(config.grazing_start_cos - config.grazing_end_cos, 1e-6f);
  if (grazing >= answers) return 0;
  const float offset = depth - config.sigma_nearest_m;
  const float sigma = config.sigma_base_m + config.sigma_growth_per_m * offset * offset;
  const float disparity_px =
      config.focal_baseline_px_m / (depth + sigma * draws.depth) + errors.lens_bias_px(x, y);
  const float steps = std::round(disparity_px / config.disparity_step_px);
  const float answer = config.focal_baseline_px_m / (steps * config.disparity_step_px);
  return answer >= config.min_depth_m && answer <= config.max_depth_m ? answer : 0;
}

/// Calls body(x, y, random) for all pixels, each with numbers of its own.
template <class Body>
void for_each_pixel(int width, int height, std::uint64_t seed, std::uint64_t stream,
                    const Body& body) {
  parallel_for(static_cast<std::size_t>(height), kNoisyRowsPerTask, [&](std::size_t row) {
    for (int x = 0; x < width; ++x) {
      Random random(seed,
                    stream + row * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
      body(x, static_cast<int>(row), random);
    }
  });
}

}  // namespace

void list_fields(SensorNoiseConfig& config, ConfigFields& fields) {
  fields.add("sigma_base_m", config.sigma_base_m, 0.f, 1.f,
             "depth noise at the nearest depth, metres");
  fields.add("sigma_growth_per_m", config.sigma_growth_per_m, 0.f, 1.f,
             "depth noise added per squared metre beyond it");
  fields.add("sigma_nearest_m", config.sigma_nearest_m, 0.f, 10.f, "the nearest depth, metres");
  fields.add("lateral_sigma_px", config.lateral_sigma_px, 0.f, 10.f, "sideways jitter, pixels");
  fields.add("focal_baseline_px_m", config.focal_baseline_px_m, 1.f, 10000.f,
             "focal length times baseline: disparity is this over depth");
  fields.add("disparity_step_px", config.disparity_step_px, 1e-4f, 1.f,
             "step of disparities, pixels");
  fields.add("correlation_px", config.correlation_px, 0.f, 1000.f,
             "width of the windows in which neighbours err alike, pixels; 0: each by itself");
  fields.add("lens_bias_px", config.lens_bias_px, 0.f, 10.f,
             "size of the smooth error of disparities that the lens makes, pixels");
  fields.add("edge_jump", config.edge_jump, 0.f, 1.f,
             "share of depth between neighbours that is an edge");
  fields.add("edge_loss", config.edge_loss, 0.f, 1.f, "share of edge pixels without an answer");
  fields.add("grazing_start_cos", config.grazing_start_cos, 0.f, 1.f,
             "from here answers get rarer");
  fields.add("grazing_end_cos", config.grazing_end_cos, -1.f, 1.f,
             "from here there are no answers");
  fields.add("random_loss", config.random_loss, 0.f, 1.f,
             "share of other pixels without an answer");
  fields.add("min_depth_m", config.min_depth_m, 0.f, 100.f, "nearest answer, metres");
  fields.add("max_depth_m", config.max_depth_m, 0.f, 100.f, "farthest answer, metres");
  fields.add("color_sigma", config.color_sigma, 0.f, 255.f, "colour noise, of 255");
  fields.add("position_sigma_m", config.position_sigma_m, 0.f, 1.f,
             "pose noise along each axis, metres");
  fields.add("rotation_sigma_rad", config.rotation_sigma_rad, 0.f, 1.f,
             "pose noise about each axis, radians");
}

DepthImage noisy_depth(const RenderedView& view, const SensorNoiseConfig& config,
                       std::uint64_t seed) {
  DepthImage noisy(view.depth.width(), view.depth.height());
  const SensorErrors errors(config, noisy.width(), seed);
  for_each_pixel(noisy.width(), noisy.height(), seed, kDepthStream,
                 [&](int x, int y, Random& random) {
                   noisy.at(x, y) = measured(view, config, errors, x, y, random);
                 });
  return noisy;
}

RgbImage noisy_color(const RgbImage& color, const SensorNoiseConfig& config, std::uint64_t seed) {
  RgbImage noisy = color;
  for_each_pixel(
      noisy.width(), noisy.height(), seed, kColorStream, [&](int x, int y, Random& random) {
        Rgb8& pixel = noisy.at(x, y);
        for (std::uint8_t* value : {&pixel.r, &pixel.g, &pixel.b}) {
          const float moved = static_cast<float>(*value) + config.color_sigma * random.normal();
          *value = static_cast<std::uint8_t>(std::clamp(moved + 0.5f, 0.f, 255.f));
        }
      });
  return noisy;
}

Pose noisy_pose(const Pose& pose, const SensorNoiseConfig& config, std::uint64_t seed) {
  if (config.position_sigma_m <= 0 && config.rotation_sigma_rad <= 0) return pose;
  Random random(seed, kPoseStream);
  Eigen::Vector3d shift, turn;
  for (int i = 0; i < 3; ++i) shift[i] = config.position_sigma_m * random.normal();
  for (int i = 0; i < 3; ++i) turn[i] = config.rotation_sigma_rad * random.normal();
  Pose noisy = pose;
  noisy.translation() += shift;
  if (turn.norm() > 0) noisy.rotate(Eigen::AngleAxisd(turn.norm(), turn.normalized()));
  return noisy;
}

}  // namespace ovimap
