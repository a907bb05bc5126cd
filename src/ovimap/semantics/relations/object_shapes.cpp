// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/relations/object_shapes.h"

#include <mutex>
#include <utility>

#include "ovimap/base/error.h"
#include "ovimap/base/parallel.h"

namespace ovimap {

struct ObjectShapes::Later {
  explicit Later(Reader reader) : read(std::move(reader)) {}

  std::once_flag asked;
  Reader read;
  std::vector<ObjectShape> whole;
};

ObjectShapes::ObjectShapes(std::vector<ObjectShape> whole)
    : outlines_(std::move(whole)), measures_(measure_objects(outlines_)) {}

ObjectShapes::ObjectShapes(std::vector<ObjectShape> outlines, std::vector<ObjectMeasures> measures,
                           Reader read_whole)
    : outlines_(std::move(outlines)),
      measures_(std::move(measures)),
      later_(std::make_shared<Later>(std::move(read_whole))) {
  OVIMAP_ASSERT(measures_.size() == outlines_.size());
}

const std::vector<ObjectShape>& ObjectShapes::whole() const {
  if (!later_) return outlines_;
  std::call_once(later_->asked, [&] {
    std::vector<ObjectShape> read = later_->read();
    OVIMAP_ASSERT(read.size() == outlines_.size());
    later_->whole = std::move(read);
    later_->read = nullptr;
  });
  return later_->whole;
}

std::vector<ObjectShape> shapes_of_instances(const Eigen::Vector3f& up,
                                             std::span<const InstanceSummary> instances,
                                             const InstanceSurfaces& surfaces) {
  constexpr std::size_t kShapesPerTask = 8;
  const Eigen::Matrix3f ground = ground_from_world(up);
  std::vector<ObjectShape> shapes(instances.size());
  parallel_for_ranges(instances.size(), kShapesPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto surface = surfaces.find(instances[i].id);
      const bool known = surface != surfaces.end() && !surface->second.empty();
      shapes[i] = known ? shape_of_points(ground, surface->second)
                        : shape_of_box(ground, instances[i].box, instances[i].centroid);
    }
  });
  return shapes;
}

}  // namespace ovimap
