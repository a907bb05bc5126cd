// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/frame/lens.h"

#include <cmath>

namespace ovimap {

namespace {

Eigen::Vector2d brown_conrady(const std::array<double, 8>& c, const Eigen::Vector2d& ray) {
  const double x = ray.x(), y = ray.y(), r2 = ray.squaredNorm();
  const double radial =
      (1 + r2 * (c[0] + r2 * (c[1] + r2 * c[4]))) / (1 + r2 * (c[5] + r2 * (c[6] + r2 * c[7])));
  return {x * radial + 2 * c[2] * x * y + c[3] * (r2 + 2 * x * x),
          y * radial + c[2] * (r2 + 2 * y * y) + 2 * c[3] * x * y};
}

Eigen::Vector2d kannala_brandt(const std::array<double, 8>& c, const Eigen::Vector2d& ray) {
  const double r = ray.norm();
  if (r == 0) return ray;
  const double angle = std::atan(r), a2 = angle * angle;
  const double bent = angle * (1 + a2 * (c[0] + a2 * (c[1] + a2 * (c[2] + a2 * c[3]))));
  return ray * (bent / r);
}

}  // namespace

Eigen::Vector2d Lens::bend(const Eigen::Vector2d& ray) const {
  switch (model) {
    case Model::kStraight:
      return ray;
    case Model::kBrownConrady:
      return brown_conrady(coefficients, ray);
    case Model::kKannalaBrandt:
      return kannala_brandt(coefficients, ray);
  }
  return ray;
}

}  // namespace ovimap
