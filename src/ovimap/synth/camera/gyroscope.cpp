// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/camera/gyroscope.h"

#include <cmath>

#include "ovimap/base/config.h"

namespace ovimap {

namespace {

constexpr std::uint64_t kStream = 0x6779726f;  // of the seed's numbers
constexpr double kStep_s = 1e-4;               // over which a turn is taken to be even

Eigen::Vector3d true_rate(const Walk& walk, double time_s) {
  const Pose turn = walk.at(time_s - kStep_s).inverse() * walk.at(time_s + kStep_s);
  const Eigen::AngleAxisd angle(Eigen::Matrix3d(turn.linear()));
  return angle.angle() * angle.axis() / (2 * kStep_s);
}

Eigen::Vector3d normal_vector(Random& random, float sigma) {
  const float x = random.normal(), y = random.normal(), z = random.normal();
  return Eigen::Vector3f(sigma * x, sigma * y, sigma * z).cast<double>();
}

}  // namespace

void list_fields(GyroscopeConfig& config, ConfigFields& fields) {
  fields.add("rate_hz", config.rate_hz, 0.f, 10000.f,
             "samples of the gyroscope a second; 0: there is none");
  fields.add("noise_rad_s_rthz", config.noise_rad_s_rthz, 0.f, 1.f,
             "density of its white noise, radians a second per root hertz");
  fields.add("offset_rad_s", config.offset_rad_s, 0.f, 10.f,
             "standard deviation of what it shows at rest, radians a second about each axis");
}

std::vector<TurnRate> gyroscope_samples(const Walk& walk, const GyroscopeConfig& config,
                                        std::uint64_t seed) {
  if (!(config.rate_hz > 0)) return {};
  Random random(seed, kStream);
  const Eigen::Vector3d offset = normal_vector(random, config.offset_rad_s);
  // White noise of a density has, in samples of a rate, half the rate as its bandwidth.
  const float sigma = config.noise_rad_s_rthz * std::sqrt(config.rate_hz / 2);
  const double step_s = 1 / static_cast<double>(config.rate_hz);
  std::vector<TurnRate> samples;
  for (int i = 0; i * step_s <= walk.seconds() + step_s; ++i)
    samples.push_back(
        {i * step_s, true_rate(walk, i * step_s) + offset + normal_vector(random, sigma)});
  return samples;
}

}  // namespace ovimap
