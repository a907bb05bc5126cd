// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "ovimap/instance/instance_mesh.h"
#include "ovimap/semantics/relations/object_measures.h"

namespace ovimap {

/// The shapes of a map's objects, by position, and what they measure. Surfaces, which are most of
/// what is known of a shape, may be read later.
class ObjectShapes {
 public:
  using Reader = std::function<std::vector<ObjectShape>()>;

  ObjectShapes() = default;
  /// All that is known of them; measures them.
  explicit ObjectShapes(std::vector<ObjectShape> whole);
  /// `outlines`: without surfaces; `measures`: taken on these; `read_whole`: gives the same shapes
  /// with them, called once when they are asked for.
  ObjectShapes(std::vector<ObjectShape> outlines, std::vector<ObjectMeasures> measures,
               Reader read_whole);

  std::size_t size() const { return outlines_.size(); }
  /// Its prism; whether it has its surface is not said.
  const ObjectShape& outline(std::size_t position) const { return outlines_[position]; }
  const std::vector<ObjectMeasures>& measures() const { return measures_; }
  /// With surfaces where they are known. Thread-safe, but not to be asked from within a parallel
  /// loop, since reading may run one. Throws what reading throws.
  const std::vector<ObjectShape>& whole() const;

 private:
  struct Later;
  std::vector<ObjectShape> outlines_;
  std::vector<ObjectMeasures> measures_;
  std::shared_ptr<Later> later_;  ///< null: the outlines are whole
};

/// Of each instance by its surface where it has one, else by its box. `up`: in the world.
std::vector<ObjectShape> shapes_of_instances(const Eigen::Vector3f& up,
                                             std::span<const InstanceSummary> instances,
                                             const InstanceSurfaces& surfaces);

}  // namespace ovimap
