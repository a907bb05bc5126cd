// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/segment/surface_breaks.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "ovimap/base/parallel.h"
#include "ovimap/base/vectorize.h"
#include "ovimap/segment/task_rows.h"

namespace ovimap {

namespace {

/// Sets `bit` where the surface breaks between q1[x] and q2[x], neighbours in a line q0 q1 q2 q3 of
/// inverse depths. On a plane the second differences of inverse depth vanish, so the step counts
/// only when it agrees with the slope on neither side.
OVIMAP_VECTORIZE void mark_breaks(const float* q0, const float* q1, const float* q2,
                                  const float* q3, int width, const DepthSurfaceConfig& config,
                                  std::uint8_t bit, std::uint8_t* breaks) {
  const float base = config.noise.base_m, slope = config.noise.quadratic_per_m;
  const float offset = config.noise.offset_m, sigmas = config.discontinuity_sigmas;
  const float ratio = config.discontinuity_ratio;
  for (int x = 0; x < width; ++x) {
    const float step = q2[x] - q1[x];
    const float size = std::fabs(step);
    const float left = q0[x] > 0.f ? std::fabs(step - (q1[x] - q0[x])) : size;
    const float right = q3[x] > 0.f ? std::fabs(step - (q3[x] - q2[x])) : size;
    const float far_q = std::min(q1[x], q2[x]);
    const float range = 1.f / (far_q + 1e-9f) - offset;
    const float noise_q = sigmas * (base + slope * range * range) * far_q * far_q;
    const bool off_slope = (sigmas > 0.f) & (std::min(left, right) > noise_q);
    const bool broken = (far_q <= 0.f) | (size > ratio * far_q) | off_slope;
    breaks[x] = static_cast<std::uint8_t>(breaks[x] | (broken ? bit : 0));
  }
}

/// Whether each pixel's surface goes on to its left and right neighbour: arms of one pixel.
OVIMAP_VECTORIZE void find_first_arms(const std::uint8_t* breaks, int width, std::uint8_t* left,
                                      std::uint8_t* right) {
  left[0] = right[width - 1] = 0;
  for (int x = 0; x + 1 < width; ++x) {
    const bool goes_on = (breaks[x] & DepthSurface::kRight) == 0;
    left[x + 1] = right[x] = goes_on;
  }
}

/// Arms of up to reach + more pixels from those of up to `reach`, more <= reach: where an arm is as
/// long as it can be, that of its last pixel follows, which lies `beyond`.
OVIMAP_VECTORIZE void lengthen_arms(const std::uint8_t* arms, const std::uint8_t* beyond,
                                    std::uint8_t reach, std::uint8_t more, int width,
                                    std::uint8_t* longer) {
  OVIMAP_NO_OVERLAP
  for (int x = 0; x < width; ++x) {
    const std::uint8_t arm = arms[x], next = beyond[x], rest = next < more ? next : more;
    longer[x] = static_cast<std::uint8_t>(arm + (arm == reach ? rest : 0));
  }
}

/// Arms along rows, as long as twice the last at a time. Beyond a row's ends there are none.
class RowArms {
 public:
  RowArms(int width, int radius)
      : width_(width),
        radius_(radius),
        left_(static_cast<std::size_t>(width + 2 * radius)),
        right_(left_.size()),
        longer_(left_.size()) {}

  void find(const std::uint8_t* breaks, std::uint8_t* left, std::uint8_t* right) {
    find_first_arms(breaks, width_, left_.data() + radius_, right_.data() + radius_);
    lengthen(left_, -1, left);
    lengthen(right_, 1, right);
  }

 private:
  void lengthen(std::vector<std::uint8_t>& arms, int side, std::uint8_t* result) {
    for (int reach = 1; reach < radius_;) {
      const int more = std::min(reach, radius_ - reach);
      const std::uint8_t* here = arms.data() + radius_;
      lengthen_arms(here, here + side * reach, static_cast<std::uint8_t>(reach),
                    static_cast<std::uint8_t>(more), width_, longer_.data() + radius_);
      std::swap(arms, longer_);
      reach += more;
    }
    std::copy_n(arms.begin() + radius_, width_, result);
  }

  int width_, radius_;
  std::vector<std::uint8_t> left_, right_, longer_;
};

/// The arm of a row's pixels from that of the row before, with the breaks between both.
OVIMAP_VECTORIZE void extend_column_arms(const std::uint8_t* last, const std::uint8_t* breaks,
                                         int width, std::uint8_t radius, std::uint8_t* arms) {
  for (int x = 0; x < width; ++x) {
    const auto longer = static_cast<std::uint8_t>(std::min(last[x], radius) + 1);
    arms[x] = breaks[x] & DepthSurface::kBelow ? std::uint8_t{0} : std::min(longer, radius);
  }
}

/// Arms of the rows [begin, end). An arm is `radius` long at most, so it is known after that many
/// rows whatever lies beyond them.
void find_column_arms(DepthSurface& surface, int begin, int end) {
  const int width = surface.breaks.width(), height = surface.breaks.height();
  const auto radius = static_cast<std::uint8_t>(surface.radius_px);
  std::vector<std::uint8_t> last(static_cast<std::size_t>(width)), arms(last.size());
  const auto keep = [&](Image<std::uint8_t>& image, int row) {
    if (row >= begin && row < end) std::copy(arms.begin(), arms.end(), image.row(row));
    std::swap(last, arms);
  };
  for (int row = std::max(0, begin - surface.radius_px); row < end; ++row) {
    std::fill(arms.begin(), arms.end(), std::uint8_t{0});
    if (row > std::max(0, begin - surface.radius_px))
      extend_column_arms(last.data(), surface.breaks.row(row - 1), width, radius, arms.data());
    keep(surface.up_px, row);
  }
  const int lowest = std::min(height, end + surface.radius_px) - 1;
  for (int row = lowest; row >= begin; --row) {
    std::fill(arms.begin(), arms.end(), std::uint8_t{0});
    if (row < lowest)
      extend_column_arms(last.data(), surface.breaks.row(row), width, radius, arms.data());
    keep(surface.down_px, row);
  }
}

}  // namespace

void find_breaks(const InverseDepth& inverse, const DepthSurfaceConfig& config,
                 DepthSurface& surface) {
  const int width = inverse.width();
  const auto rows = static_cast<std::size_t>(inverse.height());
  parallel_for_ranges(rows, kPixelRowsPerTask, [&](std::size_t begin, std::size_t end) {
    RowArms arms(width, surface.radius_px);
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      const float* q = inverse.row(y);
      std::uint8_t* breaks = surface.breaks.row(y);
      std::fill_n(breaks, width, std::uint8_t{0});
      mark_breaks(q - 1, q, q + 1, q + 2, width, config, DepthSurface::kRight, breaks);
      mark_breaks(inverse.row(y - 1), q, inverse.row(y + 1), inverse.row(y + 2), width, config,
                  DepthSurface::kBelow, breaks);
      arms.find(breaks, surface.left_px.row(y), surface.right_px.row(y));
    }
  });
  parallel_for_ranges(rows, kPixelRowsPerTask, [&](std::size_t begin, std::size_t end) {
    find_column_arms(surface, static_cast<int>(begin), static_cast<int>(end));
  });
}

}  // namespace ovimap
