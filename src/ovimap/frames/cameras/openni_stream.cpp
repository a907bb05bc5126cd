// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/cameras/openni_stream.h"

#include <tuple>
#include <vector>

#include "ovimap/frames/frame/field_of_view.h"

namespace ovimap {

namespace {

constexpr int kWantedFps = 30;

bool readable(OniSensorType sensor, OniPixelFormat format) {
  return sensor == ONI_SENSOR_COLOR
             ? format == ONI_PIXEL_FORMAT_RGB888
             : format == ONI_PIXEL_FORMAT_DEPTH_1_MM || format == ONI_PIXEL_FORMAT_DEPTH_100_UM;
}

int pixel_bytes(OniPixelFormat format) {
  return format == ONI_PIXEL_FORMAT_RGB888 ? 3 : 2;
}

/// The best of the modes that are read; format 0: there is none.
OniVideoMode choose_mode(const OniSensorInfo* info, OniSensorType sensor, ImageSize wanted) {
  const auto rank = [&](const OniVideoMode& mode) {
    return std::tuple(mode.resolutionX == wanted.width && mode.resolutionY == wanted.height,
                      mode.resolutionX * mode.resolutionY, mode.fps == kWantedFps, mode.fps);
  };
  std::vector<OniVideoMode> modes;
  for (int i = 0; info && i < info->numSupportedVideoModes; ++i)
    if (readable(sensor, info->pSupportedVideoModes[i].pixelFormat))
      modes.push_back(info->pSupportedVideoModes[i]);
  const auto best = std::max_element(
      modes.begin(), modes.end(), [&](const auto& a, const auto& b) { return rank(a) < rank(b); });
  return best == modes.end() ? OniVideoMode{} : *best;
}

}  // namespace

OpenNiStream::OpenNiStream(const OpenNiLibrary& library, OniDeviceHandle device,
                           const std::string& device_name, OniSensorType sensor, ImageSize wanted)
    : library_(library),
      name_(concat(device_name, sensor == ONI_SENSOR_COLOR ? ": colour" : ": depth")),
      mode_(choose_mode(library.DeviceGetSensorInfo(device, sensor), sensor, wanted)) {
  if (mode_.pixelFormat == 0)
    throw Error(concat(device_name, " sends no ",
                       sensor == ONI_SENSOR_COLOR ? "colour as RGB888" : "depth in millimetres",
                       " by OpenNI; both depth and colour are needed"));
  if (library.DeviceCreateStream(device, sensor, &handle_) != ONI_STATUS_OK)
    throw Error(
        concat(name_, " cannot be opened (", library.fault(), "); plug the camera in anew"));
  library.StreamSetProperty(handle_, ONI_STREAM_PROPERTY_VIDEO_MODE, &mode_, sizeof(mode_));
  OniBool mirrored = FALSE;
  int bytes = sizeof(mirrored);
  library.StreamSetProperty(handle_, ONI_STREAM_PROPERTY_MIRRORING, &mirrored, sizeof(mirrored));
  mirrored_ = library.StreamGetProperty(handle_, ONI_STREAM_PROPERTY_MIRRORING, &mirrored,
                                        &bytes) == ONI_STATUS_OK &&
              mirrored != FALSE;
}

OpenNiStream::~OpenNiStream() {
  drop();
  if (!handle_) return;
  library_.StreamStop(handle_);
  library_.StreamDestroy(handle_);
}

void OpenNiStream::start() {
  if (library_.StreamStart(handle_) != ONI_STATUS_OK)
    throw Error(concat(name_, " cannot be started (", library_.fault(),
                       "); close other programs that use the camera, and plug it in anew"));
}

PinholeCamera OpenNiStream::camera() const {
  const PinholeCamera camera = camera_of_view(mode_.resolutionX, mode_.resolutionY,
                                              property(ONI_STREAM_PROPERTY_HORIZONTAL_FOV),
                                              property(ONI_STREAM_PROPERTY_VERTICAL_FOV));
  if (!camera.valid()) throw Error(concat(name_, ": the camera does not say how much it sees"));
  return camera;
}

void OpenNiStream::take() {
  drop();
  if (library_.StreamReadFrame(handle_, &image_) != ONI_STATUS_OK) image_ = nullptr;
  if (image_ && !plausible(*image_)) drop();
}

void OpenNiStream::drop() {
  if (image_) library_.FrameRelease(image_);
  image_ = nullptr;
}

/// 0 where the stream has no such property.
float OpenNiStream::property(int id) const {
  float value = 0;
  int bytes = sizeof(value);
  return library_.StreamGetProperty(handle_, id, &value, &bytes) == ONI_STATUS_OK ? value : 0;
}

/// Of the size that was asked for, and whole.
bool OpenNiStream::plausible(const OniFrame& image) const {
  return image.width == mode_.resolutionX && image.height == mode_.resolutionY &&
         image.videoMode.pixelFormat == mode_.pixelFormat &&
         image.stride >= image.width * pixel_bytes(mode_.pixelFormat) &&
         image.dataSize >=
             (image.height - 1) * image.stride + image.width * pixel_bytes(mode_.pixelFormat);
}

}  // namespace ovimap
