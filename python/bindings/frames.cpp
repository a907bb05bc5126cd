// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include "arrays.h"
#include "bindings.h"
#include "ovimap/frames/frame/frame_source.h"

namespace ovimap::python {

namespace {

using ColorView = nb::ndarray<nb::numpy, const std::uint8_t, nb::shape<-1, -1, 3>>;
using DepthView = nb::ndarray<nb::numpy, const float, nb::ndim<2>>;

std::string camera_text(const PinholeCamera& camera) {
  return concat("PinholeCamera(width=", camera.width, ", height=", camera.height,
                ", fx=", camera.fx, ", fy=", camera.fy, ", cx=", camera.cx, ", cy=", camera.cy,
                ")");
}

template <class Pixel>
void require_size(const Image<Pixel>& image, const PinholeCamera& camera, const char* name,
                  const char* camera_name) {
  if (image.width() != camera.width || image.height() != camera.height)
    throw nb::value_error(concat(name, " must be of the size of ", camera_name, ", ", camera.width,
                                 " wide and ", camera.height, " high; came ", image.width(),
                                 " wide and ", image.height(), " high")
                              .c_str());
}

void require_valid(const PinholeCamera& camera, const char* name) {
  if (!camera.valid())
    throw nb::value_error(concat(name,
                                 " must have a size and focal lengths above 0, all finite; "
                                 "came ",
                                 camera_text(camera))
                              .c_str());
}

struct FrameArguments {
  std::optional<PinholeCamera> color_camera;
  nb::object color_from_depth;
  std::optional<std::int64_t> index;
  std::string name;
  double timestamp_s;
  std::optional<double> depth_scale;
  float min_depth_m, max_depth_m;
};

Frame make_frame(nb::handle color, nb::handle depth, nb::handle world_from_camera,
                 const PinholeCamera& camera, const FrameArguments& arguments) {
  Frame frame;
  frame.color_camera = arguments.color_camera.value_or(camera);
  frame.depth_camera = camera;
  require_valid(frame.depth_camera, "camera");
  require_valid(frame.color_camera, "color_camera");
  frame.color = read_color(color);
  frame.depth =
      read_depth(depth, arguments.depth_scale, arguments.min_depth_m, arguments.max_depth_m);
  require_size(frame.depth, frame.depth_camera, "depth", "camera");
  require_size(frame.color, frame.color_camera, "color",
               arguments.color_camera ? "color_camera" : "camera");
  frame.world_from_camera = read_pose(world_from_camera, "world_from_camera");
  if (!arguments.color_from_depth.is_none())
    frame.color_from_depth = read_pose(arguments.color_from_depth, "color_from_depth");
  frame.index = arguments.index.value_or(-1);  // a mapper numbers it
  frame.name = arguments.name;
  frame.timestamp_s = arguments.timestamp_s;
  return frame;
}

void bind_camera(nb::module_& module) {
  nb::class_<PinholeCamera>(module, "PinholeCamera",
                            "Pinhole camera without distortion: x right, y down, z forward; whole "
                            "pixel coordinates are pixel centres. All figures in pixels.")
      .def(
          "__init__",
          [](PinholeCamera* self, int width, int height, float fx, float fy, float cx, float cy) {
            new (self) PinholeCamera{width, height, fx, fy, cx, cy};
          },
          nb::arg("width"), nb::arg("height"), nb::arg("fx"), nb::arg("fy"), nb::arg("cx"),
          nb::arg("cy"))
      .def_ro("width", &PinholeCamera::width)
      .def_ro("height", &PinholeCamera::height)
      .def_ro("fx", &PinholeCamera::fx)
      .def_ro("fy", &PinholeCamera::fy)
      .def_ro("cx", &PinholeCamera::cx)
      .def_ro("cy", &PinholeCamera::cy)
      .def("scaled_to", &PinholeCamera::scaled_to, nb::arg("width"), nb::arg("height"),
           "The same view at another image size.")
      .def("__eq__",
           [](const PinholeCamera& a, nb::handle b) {
             return nb::isinstance<PinholeCamera>(b) && a == nb::cast<const PinholeCamera&>(b);
           })
      .def("__repr__", &camera_text);
}

constexpr const char* kFrameText = R"(One posed RGB-D observation.

color: uint8 [height, width, 3], red first, of color_camera's size.
depth: float32 or float64 [height, width] in metres along the optical axis, of camera's size; or
    integers, depth_scale of which are a metre. Depth that is 0, not finite or not between
    min_depth_m and max_depth_m counts as none.
world_from_camera: [4, 4], pose of the depth camera: x_in_world = world_from_camera @ x_in_camera.
camera: of the depth; also of the colour unless color_camera is given.
color_from_depth: [4, 4], x_in_color = color_from_depth @ x_in_depth; identity when left out.
index: position in its source; left out: a mapper numbers its frames as they come.
name: names 2D mask files. timestamp_s: seconds.

Arrays may have any strides and come from anything that speaks DLPack or the buffer protocol; they
are copied once, because the frame owns its images. Raises TypeError for another element type and
ValueError for another shape or a pose that is no rigid transform.)";

}  // namespace

void bind_frames(nb::module_& module) {
  bind_camera(module);
  const FrameSourceConfig limits;
  nb::class_<Frame>(module, "Frame", kFrameText)
      .def(
          "__init__",
          [](Frame* self, const nb::object& color, const nb::object& depth,
             const nb::object& world_from_camera, const PinholeCamera& camera,
             std::optional<PinholeCamera> color_camera, const nb::object& color_from_depth,
             std::optional<std::int64_t> index, const std::string& name, double timestamp_s,
             std::optional<double> depth_scale, float min_depth_m, float max_depth_m) {
            new (self) Frame(make_frame(color, depth, world_from_camera, camera,
                                        {color_camera, color_from_depth, index, name, timestamp_s,
                                         depth_scale, min_depth_m, max_depth_m}));
          },
          nb::arg("color").none(), nb::arg("depth").none(), nb::arg("world_from_camera").none(),
          nb::arg("camera"), nb::kw_only(), nb::arg("color_camera") = nb::none(),
          nb::arg("color_from_depth") = nb::none(), nb::arg("index") = nb::none(),
          nb::arg("name") = "", nb::arg("timestamp_s") = 0.0, nb::arg("depth_scale") = nb::none(),
          nb::arg("min_depth_m") = limits.min_depth_m, nb::arg("max_depth_m") = limits.max_depth_m)
      .def_ro("index", &Frame::index, "position in its source; -1: not numbered yet")
      .def_ro("name", &Frame::name, "file stem of the colour image")
      .def_ro("timestamp_s", &Frame::timestamp_s, "seconds")
      .def_ro("color_camera", &Frame::color_camera)
      .def_ro("camera", &Frame::depth_camera, "of the depth")
      .def_prop_ro(
          "color",
          [](const Frame& frame) {
            return view<ColorView>(reinterpret_cast<const std::uint8_t*>(frame.color.data()),
                                   {static_cast<std::size_t>(frame.color.height()),
                                    static_cast<std::size_t>(frame.color.width()), 3},
                                   nb::find(frame));
          },
          "uint8 [height, width, 3], red first; a view of the frame's memory")
      .def_prop_ro(
          "depth",
          [](const Frame& frame) {
            return view<DepthView>(frame.depth.data(),
                                   {static_cast<std::size_t>(frame.depth.height()),
                                    static_cast<std::size_t>(frame.depth.width())},
                                   nb::find(frame));
          },
          "float32 [height, width], metres along the optical axis, 0 = none; a view of the frame's "
          "memory")
      .def_prop_ro(
          "world_from_camera",
          [](const Frame& frame) { return to_matrix(frame.world_from_camera); },
          nb::rv_policy::automatic, "float64 [4, 4], of the depth camera")
      .def_prop_ro(
          "color_from_depth", [](const Frame& frame) { return to_matrix(frame.color_from_depth); },
          nb::rv_policy::automatic, "float64 [4, 4]")
      .def_prop_ro("registered", &Frame::registered, "whether colour and depth share one camera")
      .def("__repr__", [](const Frame& frame) {
        return concat("Frame(index=", frame.index, ", name='", frame.name,
                      "', timestamp_s=", frame.timestamp_s, ", depth ", frame.depth.width(), "x",
                      frame.depth.height(), ")");
      });
}

}  // namespace ovimap::python
