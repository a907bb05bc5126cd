// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/map/rays/distance_transform.h"

#include <array>
#include <limits>

#include "ovimap/base/error.h"
#include "ovimap/base/parallel.h"

namespace ovimap {

namespace {

/// The transform along one line. Keeps its buffers between lines.
class LineTransform {
 public:
  explicit LineTransform(std::size_t length) : input_(length), apex_(length), from_(length + 1) {}

  /// Replaces the values at `line`, `line` + stride, ... by the lower envelope of the parabolas
  /// that stand on them.
  void run(float* line, std::size_t stride) {
    for (std::size_t i = 0; i < input_.size(); ++i) input_[i] = line[i * stride];
    const std::size_t last = find_envelope();
    std::size_t k = 0;
    for (std::size_t i = 0; i < input_.size(); ++i) {
      while (k < last && from_[k + 1] < static_cast<double>(i)) ++k;
      const double away = static_cast<double>(i) - static_cast<double>(apex_[k]);
      const auto value = static_cast<float>(away * away + double{input_[apex_[k]]});
      line[i * stride] = std::min(value, kNoObstacle);
    }
  }

 private:
  /// Which parabolas make the envelope, and from where on each does. Returns the last one's place.
  std::size_t find_envelope() {
    constexpr double kFar = std::numeric_limits<double>::infinity();
    std::size_t k = 0;
    apex_[0] = 0;
    from_[0] = -kFar;
    from_[1] = kFar;
    for (std::size_t q = 1; q < input_.size(); ++q) {
      double meets = crossing(apex_[k], q);
      while (meets <= from_[k]) meets = crossing(apex_[--k], q);
      apex_[++k] = q;
      from_[k] = meets;
      from_[k + 1] = kFar;
    }
    return k;
  }

  /// Where the parabola of `right` goes below that of `left`.
  double crossing(std::size_t left, std::size_t right) const {
    const auto l = static_cast<double>(left), r = static_cast<double>(right);
    return ((double{input_[right]} + r * r) - (double{input_[left]} + l * l)) / (2 * (r - l));
  }

  std::vector<float> input_;
  std::vector<std::size_t> apex_;
  std::vector<double> from_;
};

}  // namespace

std::vector<float> squared_distances(std::span<const std::uint8_t> obstacle,
                                     const Eigen::Vector3i& size) {
  const std::array<std::size_t, 3> count = {static_cast<std::size_t>(size.x()),
                                            static_cast<std::size_t>(size.y()),
                                            static_cast<std::size_t>(size.z())};
  OVIMAP_ASSERT(obstacle.size() == count[0] * count[1] * count[2]);
  std::vector<float> distances(obstacle.size());
  for (std::size_t i = 0; i < obstacle.size(); ++i)
    distances[i] = obstacle[i] != 0 ? 0.f : kNoObstacle;
  std::size_t stride = 1;
  for (std::size_t axis = 0; axis < 3; stride *= count[axis++]) {
    if (count[axis] < 2) continue;
    constexpr std::size_t kLinesPerTask = 64;
    const std::size_t lines = obstacle.size() / count[axis], length = count[axis];
    parallel_for_ranges(lines, kLinesPerTask, [&](std::size_t begin, std::size_t end) {
      LineTransform transform(length);
      for (std::size_t line = begin; line < end; ++line)
        transform.run(&distances[line / stride * stride * length + line % stride], stride);
    });
  }
  return distances;
}

}  // namespace ovimap
