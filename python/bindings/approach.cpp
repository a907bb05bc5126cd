// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "bindings.h"
#include "ovimap/base/config.h"
#include "ovimap/io/map_file/map_edits.h"
#include "ovimap/pipeline/approach/approach.h"
#include "saved_map.h"
#include "without_gil.h"

namespace ovimap::python {

const StandingSpace& SavedMap::standing_space() {
  const std::lock_guard lock(details_mutex_);
  if (!standing_) standing_ = make_standing_space(load_corrected_map(path_));
  return *standing_;
}

namespace {

using Place = std::array<float, 2>;

Place place_of(const Eigen::Vector2f& point) {
  return {point.x(), point.y()};
}

/// Throws Error for a value that its setting does not take.
void check_ranges(ApproachConfig config) {
  ConfigFields fields;
  list_fields(config, fields);
  for (const ConfigField& field : fields.fields()) field.set(field.get());
}

Approach approach(SavedMap& map, InstanceId id, const std::optional<Place>& start, float radius_m,
                  float camera_height_m, float fov_deg, float range_m, int poses) {
  ApproachConfig config;
  config.radius_m = radius_m;
  config.camera_height_m = camera_height_m;
  config.fov_deg = fov_deg;
  config.range_m = range_m;
  config.poses = poses;
  check_ranges(config);
  map.position(id);
  std::optional<Eigen::Vector2f> from;
  if (start) from = Eigen::Vector2f((*start)[0], (*start)[1]);
  return find_approach(map.standing_space(), id, config, from);
}

void bind_route_values(nb::module_& module) {
  nb::class_<ApproachPose>(module, "ApproachPose", "A place to stand, in a frame whose z is up.")
      .def_prop_ro("x", [](const ApproachPose& pose) { return pose.place_m.x(); })
      .def_prop_ro("y", [](const ApproachPose& pose) { return pose.place_m.y(); })
      .def_ro("yaw", &ApproachPose::yaw_rad, "of the gaze, radians from x towards y")
      .def_ro("tilt", &ApproachPose::tilt_rad, "of the gaze, radians upwards from level")
      .def_ro("seen", &ApproachPose::seen, "share of the object's visible surface")
      .def_ro("distance_m", &ApproachPose::distance_m, "from the camera to the object's middle")
      .def_ro("way_m", &ApproachPose::way_m, "length of the way; 0 without a start")
      .def_prop_ro(
          "way",
          [](const ApproachPose& pose) {
            std::vector<Place> way;
            for (const Eigen::Vector2f& corner : pose.way) way.push_back(place_of(corner));
            return way;
          },
          nb::sig("def way(self) -> list[list[float]]"),
          "corners of the way, from the start to here; empty without a start")
      .def("__repr__", [](const ApproachPose& pose) {
        return concat("ApproachPose(x=", pose.place_m.x(), ", y=", pose.place_m.y(),
                      ", yaw=", pose.yaw_rad, ", seen=", pose.seen, ")");
      });
  nb::class_<Approach>(module, "Approach", "Where to stand to see an object.")
      .def_ro("poses", &Approach::poses, "best first")
      .def_ro("reason", &Approach::reason, "why there are none; else empty")
      .def("__repr__", [](const Approach& found) {
        return found.poses.empty() ? concat("Approach(none: ", found.reason, ")")
                                   : concat("Approach(", found.poses.size(), " poses)");
      });
}

}  // namespace

void bind_approach(nb::module_& module, nb::class_<SavedMap>& map) {
  bind_route_values(module);
  const ApproachConfig usual;
  map.def("approach", &approach, nb::arg("id"), nb::kw_only(), nb::arg("start") = nb::none(),
          nb::arg("radius_m") = usual.radius_m, nb::arg("camera_height_m") = usual.camera_height_m,
          nb::arg("fov_deg") = usual.fov_deg, nb::arg("range_m") = usual.range_m,
          nb::arg("poses") = usual.poses, nb::call_guard<WithoutGil>(),
          nb::sig("def approach(self, id: int, *, start: collections.abc.Sequence[float] | None = "
                  "None, radius_m: float = 0.25, camera_height_m: float = 1.2, fov_deg: float = "
                  "60.0, range_m: float = 2.0, poses: int = 3) -> Approach"),
          "Where a round robot stands to see an object, and how it gets there from start (x, y), "
          "in the frame of the exported grid (docs/robots.md). Reads the voxels the first time. "
          "Raises Error for an unknown id, a value out of range and a map without voxels.");
}

}  // namespace ovimap::python
