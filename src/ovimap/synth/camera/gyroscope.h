// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "ovimap/frames/recording/gyroscope.h"
#include "ovimap/synth/camera/walk.h"

namespace ovimap {

class ConfigFields;

/// The gyroscope of phones and depth cameras. Noise and offset are what the data sheet of Bosch's
/// BMI055, which depth cameras have, calls typical: 0.014 degrees a second per root hertz, and 1
/// degree a second at rest.
struct GyroscopeConfig {
  float rate_hz = 0;                   ///< samples a second; 0: there is none
  float noise_rad_s_rthz = 0.000244f;  ///< density of white noise, radians a second per root hertz
  float offset_rad_s = 0.01745f;  ///< standard deviation of what it shows at rest, about each axis
};
void list_fields(GyroscopeConfig& config, ConfigFields& fields);

/// What it measures on a walk, about the axes of the camera. The same seed gives the same samples.
std::vector<TurnRate> gyroscope_samples(const Walk& walk, const GyroscopeConfig& config,
                                        std::uint64_t seed);

}  // namespace ovimap
