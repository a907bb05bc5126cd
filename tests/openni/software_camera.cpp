// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// A driver for OpenNI whose camera is a file: what the tests plug in. It answers as a camera does
// that brings its depth to the colour image, shows all frames once at its rate, and is unplugged.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <Driver/OniDriverAPI.h>

#include "camera_film.h"

namespace {

using ovimap::CameraFilm;
using ovimap::FilmFrame;
namespace driver = oni::driver;

constexpr const char* kFilmVariable = "OVIMAP_CAMERA_FILM";
constexpr const char* kUri = "software://camera";

/// The value of a property, where the caller has room for it.
template <class T>
OniStatus give(const T& value, void* data, int* size) {
  if (*size < static_cast<int>(sizeof(T))) return ONI_STATUS_BAD_PARAMETER;
  std::memcpy(data, &value, sizeof(T));
  *size = sizeof(T);
  return ONI_STATUS_OK;
}

class Stream : public driver::StreamBase {
 public:
  Stream(const CameraFilm& film, OniSensorType sensor, const OniVideoMode& mode)
      : film_(film), sensor_(sensor), mode_(mode) {}

  OniStatus start() override {
    running_ = true;
    return ONI_STATUS_OK;
  }
  void stop() override { running_ = false; }
  bool running() const { return running_; }

  OniBool isPropertySupported(int id) override {
    int room = 64;
    char value[64];
    return getProperty(id, value, &room) == ONI_STATUS_OK;
  }
  OniStatus getProperty(int id, void* data, int* size) override {
    switch (id) {
      case ONI_STREAM_PROPERTY_VIDEO_MODE:
        return give(mode_, data, size);
      case ONI_STREAM_PROPERTY_HORIZONTAL_FOV:
        return give(film_.horizontal_fov_rad, data, size);
      case ONI_STREAM_PROPERTY_VERTICAL_FOV:
        return give(film_.vertical_fov_rad, data, size);
      case ONI_STREAM_PROPERTY_MIRRORING:
        return give(mirrored_, data, size);
      case ONI_STREAM_PROPERTY_CROPPING:
        return give(OniCropping{}, data, size);
      case ONI_STREAM_PROPERTY_MAX_VALUE:
        return give(10000, data, size);
      case ONI_STREAM_PROPERTY_STRIDE:
        return give(stride(), data, size);
      default:
        return ONI_STATUS_NOT_SUPPORTED;
    }
  }
  OniStatus setProperty(int id, const void* data, int size) override {
    if (id == ONI_STREAM_PROPERTY_MIRRORING && size == sizeof(mirrored_))
      std::memcpy(&mirrored_, data, sizeof(mirrored_));
    else if (id == ONI_STREAM_PROPERTY_VIDEO_MODE && size == sizeof(mode_))
      return std::memcmp(data, &mode_, sizeof(mode_)) == 0 ? ONI_STATUS_OK
                                                           : ONI_STATUS_NOT_SUPPORTED;
    else
      return ONI_STATUS_NOT_SUPPORTED;
    return ONI_STATUS_OK;
  }

  void show(const FilmFrame& shown, int number) {
    if (!running_) return;
    OniFrame* frame = getServices().acquireFrame();
    if (frame == nullptr) return;
    frame->sensorType = sensor_;
    frame->timestamp = shown.time_us;
    frame->frameIndex = number;
    frame->videoMode = mode_;
    frame->width = film_.width;
    frame->height = film_.height;
    frame->croppingEnabled = frame->cropOriginX = frame->cropOriginY = 0;
    frame->stride = stride();
    frame->dataSize = frame->stride * film_.height;
    fill(shown, static_cast<std::uint8_t*>(frame->data));
    raiseNewFrame(frame);
    getServices().releaseFrame(frame);
  }

 private:
  int pixel_bytes() const { return sensor_ == ONI_SENSOR_DEPTH ? 2 : 3; }
  int stride() const { return film_.width * pixel_bytes(); }
  /// As a camera does: with left and right swapped until it is told otherwise.
  void fill(const FilmFrame& shown, std::uint8_t* out) const {
    const auto* pixels = sensor_ == ONI_SENSOR_DEPTH
                             ? reinterpret_cast<const std::uint8_t*>(shown.depth.data())
                             : shown.color.data();
    for (int v = 0; v < film_.height; ++v)
      for (int u = 0; u < film_.width; ++u) {
        const int from = mirrored_ ? film_.width - 1 - u : u;
        std::memcpy(out + v * stride() + u * pixel_bytes(),
                    pixels + v * stride() + from * pixel_bytes(),
                    static_cast<std::size_t>(pixel_bytes()));
      }
  }

  const CameraFilm& film_;
  OniSensorType sensor_;
  OniVideoMode mode_;
  OniBool mirrored_ = TRUE;
  std::atomic<bool> running_ = false;
};

class Device : public driver::DeviceBase {
 public:
  explicit Device(const CameraFilm& film) : film_(film) {
    for (const OniSensorType sensor : {ONI_SENSOR_DEPTH, ONI_SENSOR_COLOR}) {
      modes_.push_back(mode(sensor));
      sensors_.push_back({sensor, 1, nullptr});
    }
    for (std::size_t i = 0; i < modes_.size(); ++i) sensors_[i].pSupportedVideoModes = &modes_[i];
  }

  OniStatus getSensorInfoList(OniSensorInfo** sensors, int* count) override {
    *sensors = sensors_.data();
    *count = static_cast<int>(sensors_.size());
    return ONI_STATUS_OK;
  }
  driver::StreamBase* createStream(OniSensorType sensor) override {
    auto& stream = sensor == ONI_SENSOR_DEPTH ? depth_ : color_;
    stream = std::make_unique<Stream>(film_, sensor, mode(sensor));
    return stream.get();
  }
  void destroyStream(driver::StreamBase* stream) override {
    if (stream == depth_.get()) depth_.reset();
    if (stream == color_.get()) color_.reset();
  }
  OniBool isPropertySupported(int id) override {
    return id == ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION;
  }
  OniBool isImageRegistrationModeSupported(OniImageRegistrationMode) override { return TRUE; }
  OniStatus getProperty(int id, void* data, int* size) override {
    return isPropertySupported(id) ? give(registration_, data, size) : ONI_STATUS_NOT_SUPPORTED;
  }
  OniStatus setProperty(int id, const void* data, int size) override {
    if (!isPropertySupported(id) || size != sizeof(registration_)) return ONI_STATUS_NOT_SUPPORTED;
    std::memcpy(&registration_, data, sizeof(registration_));
    return ONI_STATUS_OK;
  }

  bool running() const { return depth_ && color_ && depth_->running() && color_->running(); }
  void show(const FilmFrame& frame, int number) {
    if (color_) color_->show(frame, number);
    if (depth_) depth_->show(frame, number);
  }

 private:
  OniVideoMode mode(OniSensorType sensor) const {
    const OniPixelFormat depth =
        film_.unit_um == 100 ? ONI_PIXEL_FORMAT_DEPTH_100_UM : ONI_PIXEL_FORMAT_DEPTH_1_MM;
    return {sensor == ONI_SENSOR_DEPTH ? depth : ONI_PIXEL_FORMAT_RGB888, film_.width, film_.height,
            film_.fps};
  }

  const CameraFilm& film_;
  std::vector<OniVideoMode> modes_;
  std::vector<OniSensorInfo> sensors_;
  std::unique_ptr<Stream> depth_, color_;
  OniImageRegistrationMode registration_ = ONI_IMAGE_REGISTRATION_OFF;
};

class Driver : public driver::DriverBase {
 public:
  explicit Driver(OniDriverServices* services) : DriverBase(services) {}

  OniStatus initialize(driver::DeviceConnectedCallback connected,
                       driver::DeviceDisconnectedCallback disconnected,
                       driver::DeviceStateChangedCallback changed, void* cookie) override {
    DriverBase::initialize(connected, disconnected, changed, cookie);
    const char* film = std::getenv(kFilmVariable);
    if (film == nullptr) return ONI_STATUS_OK;  // nothing is plugged in
    film_ = ovimap::read_film(film);
    std::strcpy(info_.uri, kUri);
    std::strcpy(info_.vendor, "ovimap");
    std::strcpy(info_.name, "software camera");
    deviceConnected(&info_);
    return ONI_STATUS_OK;
  }
  driver::DeviceBase* deviceOpen(const char*, const char*) override {
    device_ = std::make_unique<Device>(film_);
    player_ = std::jthread([this](const std::stop_token& stop) { play(stop); });
    return device_.get();
  }
  void deviceClose(driver::DeviceBase*) override {
    player_ = {};
    device_.reset();
  }
  OniStatus tryDevice(const char* uri) override {
    return info_.uri[0] != 0 && std::strcmp(uri, kUri) == 0 ? ONI_STATUS_OK : ONI_STATUS_NO_DEVICE;
  }
  void shutdown() override { player_ = {}; }

 private:
  void play(const std::stop_token& stop) {
    const std::chrono::duration<double> period(1. / film_.fps);
    while (!stop.stop_requested() && !device_->running()) std::this_thread::sleep_for(period);
    for (std::size_t i = 0; i < film_.frames.size() && !stop.stop_requested(); ++i) {
      device_->show(film_.frames[i], static_cast<int>(i + 1));
      std::this_thread::sleep_for(period);
    }
    if (!stop.stop_requested()) deviceDisconnected(&info_);
  }

  CameraFilm film_;
  OniDeviceInfo info_{};
  std::unique_ptr<Device> device_;
  std::jthread player_;
};

}  // namespace

#define XN_NEW(type, argument) new type(argument)
#define XN_DELETE(pointer) delete pointer
ONI_EXPORT_DRIVER(Driver)
