// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/decoding/frame_decoder.h"

#include <algorithm>

#include "ovimap/image/codec.h"

namespace ovimap {

namespace {

constexpr std::size_t kDepthValues = 65536;

bool is_given(const PinholeCamera& camera) {
  return camera.width > 0 || camera.height > 0 || camera.fx > 0 || camera.fy > 0;
}

CameraRig completed(CameraRig rig) {
  if (!is_given(rig.color_camera))
    rig.color_camera = rig.depth_camera, rig.color_lens = rig.depth_lens;
  if (!is_given(rig.depth_camera))
    rig.depth_camera = rig.color_camera, rig.depth_lens = rig.color_lens;
  const auto check = [](const PinholeCamera& camera, const char* name) {
    if (!camera.valid())
      throw Error(concat("the ", name,
                         " camera is not known whole; give width, height, fx, fy, cx and cy"));
  };
  check(rig.depth_camera, "depth");
  check(rig.color_camera, "colour");
  return rig;
}

/// What `decode` throws, with the name of the image before it.
template <class Decode>
auto named(const char* name, const Decode& decode) {
  try {
    return decode();
  } catch (const Error& fault) {
    throw Error(concat(name, " ", fault.what()));
  }
}

ImageSize size_of(const PinholeCamera& camera) {
  return {camera.width, camera.height};
}

}  // namespace

RgbImage decode_color(std::span<const std::uint8_t> bytes, const PinholeCamera& camera) {
  return decode_rgb(bytes, size_of(camera));
}

Image<std::uint16_t> decode_stored_depth(std::span<const std::uint8_t> bytes,
                                         const PinholeCamera& camera) {
  GrayPng png = decode_gray(bytes, size_of(camera));
  if (png.bits != 16) throw Error(concat("has ", png.bits, " bits, expected 16"));
  return std::move(png.values);
}

bool has_depth(const DepthImage& depth) {
  return std::any_of(depth.begin(), depth.end(), [](float metres) { return metres > 0; });
}

DepthUnits::DepthUnits(const CameraRig& rig, const FrameSourceConfig& config)
    : metres_(kDepthValues) {
  for (std::size_t stored = 0; stored < kDepthValues; ++stored) {
    const auto metres = static_cast<float>(static_cast<double>(stored) / rig.depth_units_per_m);
    const bool valid = stored > 0 && metres >= config.min_depth_m && metres <= config.max_depth_m;
    metres_[stored] = valid ? metres : 0.f;
  }
  for (const std::uint16_t stored : rig.invalid_depth) metres_[stored] = 0;
}

DepthImage DepthUnits::metres(const Image<std::uint16_t>& stored) const {
  auto depth = DepthImage::unset(stored.width(), stored.height());
  for (std::size_t i = 0; i < depth.size(); ++i) depth[i] = metres_[stored[i]];
  return depth;
}

FrameDecoder::FrameDecoder(const CameraRig& rig, const FrameSourceConfig& config)
    : rig_(completed(rig)), config_(config), units_(rig_, config), rectification_(rig_) {}

Frame FrameDecoder::decode(std::span<const std::uint8_t> color, std::span<const std::uint8_t> depth,
                           const std::optional<Eigen::Matrix4d>& pose) const {
  const std::string fault = pose ? pose_fault(*pose) : "";
  if (!fault.empty()) throw Error(concat("the pose is no rigid transform: ", fault));
  Frame frame;
  frame.color_camera = rig_.color_camera;
  frame.depth_camera = rig_.depth_camera;
  frame.color_from_depth = rig_.color_from_depth;
  frame.posed = pose.has_value();
  if (pose) frame.world_from_camera = rig_.world_from_depth_camera(*pose);
  frame.depth =
      units_.metres(named("depth", [&] { return decode_stored_depth(depth, frame.depth_camera); }));
  if (!has_depth(frame.depth))
    throw Error(
        concat("depth has no value from ", config_.min_depth_m, " to ", config_.max_depth_m, " m"));
  frame.color = named("color", [&] { return decode_color(color, frame.color_camera); });
  rectification_.apply(frame);
  return frame;
}

}  // namespace ovimap
