// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/recording/rig_completion.h"

#include "ovimap/base/error.h"
#include "ovimap/image/codec.h"

namespace ovimap {

namespace {

constexpr const char* kExample =
    "write it into camera.yaml there, as: camera: {width: 640, height: 480, fx: 525, fy: 525, cx: "
    "319.5, "
    "cy: 239.5, depth_scale: 1000}";

template <class ReadOne>
ImageSize first_readable(const Recording& recording, ReadOne&& read_one) {
  for (const RecordedFrame& frame : recording.frames) {
    try {
      const auto image = read_one(frame);
      return {image.width(), image.height()};
    } catch (const Error&) {
      // A broken image is a fault of its frame; the next one tells the size as well.
    }
  }
  return {};
}

ImageSize depth_size(const Recording& recording) {
  return first_readable(recording,
                        [](const RecordedFrame& f) { return read_gray(f.depth).values; });
}

ImageSize color_size(const Recording& recording) {
  return first_readable(recording, [](const RecordedFrame& f) { return read_rgb(f.color); });
}

bool has_intrinsics(const PinholeCamera& camera) {
  return camera.fx > 0 || camera.fy > 0;
}

std::string missing_keys(const PinholeCamera& camera) {
  std::string keys;
  const auto require = [&keys](bool given, const char* name) {
    if (!given) keys += concat(keys.empty() ? "" : ", ", name);
  };
  require(camera.width > 0, "width");
  require(camera.height > 0, "height");
  require(camera.fx > 0, "fx");
  require(camera.fy > 0, "fy");
  require(camera.cx != 0 || camera.cy != 0, "cx, cy");
  return keys;
}

void fill_size(PinholeCamera& camera, ImageSize size) {
  if (camera.width <= 0) camera.width = size.width;
  if (camera.height <= 0) camera.height = size.height;
}

/// One camera describes both only if their images have one size.
void copy_single_camera(const std::filesystem::path& folder, CameraRig& rig) {
  const bool has_depth = has_intrinsics(rig.depth_camera);
  if (has_depth == has_intrinsics(rig.color_camera)) return;
  const PinholeCamera& given = has_depth ? rig.depth_camera : rig.color_camera;
  PinholeCamera& other = has_depth ? rig.color_camera : rig.depth_camera;
  if (other.width != given.width || other.height != given.height)
    throw Error(concat(folder.string(), ": only the ", has_depth ? "depth" : "colour",
                       " camera is known, ", given.width, "x", given.height,
                       ", but the other images are ", other.width, "x", other.height,
                       "; give both depth_camera and color_camera in camera.yaml"));
  other = given;
  (has_depth ? rig.color_lens : rig.depth_lens) = has_depth ? rig.depth_lens : rig.color_lens;
}

}  // namespace

void complete_cameras(Recording& recording) {
  CameraRig& rig = recording.rig;
  if (!has_intrinsics(rig.depth_camera) && !has_intrinsics(rig.color_camera))
    throw Error(
        concat(recording.folder.string(), ": the camera's intrinsics are missing; ", kExample));
  if (rig.depth_camera.width <= 0 || rig.depth_camera.height <= 0)
    fill_size(rig.depth_camera, depth_size(recording));
  if (rig.color_camera.width <= 0 || rig.color_camera.height <= 0)
    fill_size(rig.color_camera, color_size(recording));
  copy_single_camera(recording.folder, rig);
  using Named = std::pair<const char*, const PinholeCamera*>;
  for (const auto& [name, camera] :
       {Named{"depth", &rig.depth_camera}, Named{"colour", &rig.color_camera}}) {
    const std::string missing = missing_keys(*camera);
    if (!missing.empty())
      throw Error(concat(recording.folder.string(), ": the ", name, " camera lacks ", missing, "; ",
                         kExample));
    if (!camera->valid())
      throw Error(
          concat(recording.folder.string(), ": the ", name, " camera is not finite; ", kExample));
  }
}

}  // namespace ovimap
