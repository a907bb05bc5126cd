// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/cameras/openni_camera.h"

#include <array>
#include <atomic>
#include <cmath>
#include <vector>

#include "ovimap/base/error.h"
#include "ovimap/frames/cameras/openni_library.h"
#include "ovimap/frames/cameras/openni_stream.h"
#include "ovimap/frames/decoding/frame_decoder.h"

namespace ovimap {

namespace {

constexpr double kStampsPerSecond = 1e6;  // of time stamps
constexpr int kWantedWidth_px = 640, kWantedHeight_px = 480;

/// The URI that is meant: `wanted`, or that of the only camera.
std::string chosen_uri(const OpenNiLibrary& library, const std::string& wanted) {
  if (!wanted.empty()) return wanted;
  OniDeviceInfo* devices = nullptr;
  int count = 0;
  if (library.GetDeviceList(&devices, &count) != ONI_STATUS_OK) count = 0;
  std::vector<std::string> uris;
  for (int i = 0; i < count; ++i) uris.emplace_back(devices[i].uri);
  if (devices) library.ReleaseDeviceList(devices);
  if (uris.empty())
    throw Error(
        "no OpenNI camera is plugged in; plug it in (docs/cameras.md, 'When no camera is found')");
  if (uris.size() == 1) return uris.front();
  throw Error(
      concat(uris.size(), " OpenNI cameras are plugged in; choose one, as openni:", uris.front()));
}

/// A device that is open.
class Device {
 public:
  Device(const OpenNiLibrary& library, const std::string& uri) : library_(library), uri_(uri) {
    if (library.DeviceOpen(uri.c_str(), &handle_) != ONI_STATUS_OK)
      throw Error(concat("the OpenNI camera '", uri, "' cannot be opened (", library.fault(),
                         "); close other programs that use it, and plug it in anew"));
    OniDeviceInfo info{};
    library.DeviceGetInfo(handle_, &info);
    name_ = concat(info.vendor, " ", info.name);
    OniDeviceCallbacks callbacks{nullptr, &disconnected, nullptr};
    library.RegisterDeviceCallbacks(&callbacks, this, &callback_);
  }
  ~Device() {
    if (callback_) library_.UnregisterDeviceCallbacks(callback_);
    library_.DeviceClose(handle_);
  }
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  OniDeviceHandle handle() const { return handle_; }
  const std::string& name() const { return name_; }
  bool gone() const { return gone_; }

 private:
  static void ONI_CALLBACK_TYPE disconnected(const OniDeviceInfo* info, void* device) {
    auto& self = *static_cast<Device*>(device);
    if (self.uri_ == info->uri) self.gone_ = true;
  }

  const OpenNiLibrary& library_;
  const std::string uri_;
  std::string name_;
  OniDeviceHandle handle_ = nullptr;
  OniCallbackHandle callback_ = nullptr;
  std::atomic<bool> gone_ = false;
};

class OpenNiCamera : public RgbdCamera {
 public:
  OpenNiCamera(const std::string& uri, const FrameSourceConfig& config)
      : config_(config),
        device_(library_, chosen_uri(library_, uri)),
        registered_(bring_depth_to_color()),
        depth_(library_, device_.handle(), device_.name(), ONI_SENSOR_DEPTH,
               {kWantedWidth_px, kWantedHeight_px}),
        color_(library_, device_.handle(), device_.name(), ONI_SENSOR_COLOR, depth_.size()),
        rig_(rig()),
        units_(rig_, config) {
    library_.DeviceEnableDepthColorSync(device_.handle());  // a device that cannot goes on without
    depth_.start();
    color_.start();
  }

  const std::string& name() const override { return device_.name(); }
  bool registered() const override { return registered_; }
  double depth_units_per_m() const override { return rig_.depth_units_per_m; }

  CameraRead next(std::chrono::milliseconds patience) override {
    const auto end = std::chrono::steady_clock::now() + patience;
    while (!device_.gone()) {
      const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
          end - std::chrono::steady_clock::now());
      if (left.count() < 0) return {};
      take_image(left);
      if (std::optional<Frame> frame = pair()) return {std::move(frame), {}};
    }
    return {{}, "was unplugged"};
  }

 private:
  bool bring_depth_to_color() {
    const OniImageRegistrationMode mode = ONI_IMAGE_REGISTRATION_DEPTH_TO_COLOR;
    return library_.DeviceIsImageRegistrationModeSupported(device_.handle(), mode) &&
           library_.DeviceSetProperty(device_.handle(), ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION,
                                      &mode, sizeof(mode)) == ONI_STATUS_OK;
  }

  CameraRig rig() const {
    CameraRig rig;
    rig.color_camera = color_.camera();
    rig.depth_camera = registered_
                           ? rig.color_camera.scaled_to(depth_.size().width, depth_.size().height)
                           : depth_.camera();
    rig.depth_units_per_m = depth_.units_per_m();
    return rig;
  }

  /// Of either stream; the images that wait are replaced by newer ones.
  void take_image(std::chrono::milliseconds patience) {
    std::array<OniStreamHandle, 2> streams = {depth_.handle(), color_.handle()};
    int ready = 0;
    if (library_.WaitForAnyStream(streams.data(), 2, &ready, static_cast<int>(patience.count())) ==
        ONI_STATUS_OK)
      (ready == 0 ? depth_ : color_).take();
  }

  /// The frame of the images that wait, when they were taken together.
  std::optional<Frame> pair() {
    if (!depth_.waiting() || !color_.waiting()) return std::nullopt;
    const double depth_s = time_s(*depth_.waiting()), color_s = time_s(*color_.waiting());
    if (std::abs(depth_s - color_s) > config_.max_time_gap_s) {
      (depth_s < color_s ? depth_ : color_).drop();  // its partner has passed
      return std::nullopt;
    }
    Frame frame;
    frame.timestamp_s = depth_s;
    frame.posed = false;
    frame.color_camera = rig_.color_camera;
    frame.depth_camera = rig_.depth_camera;
    frame.depth = units_.metres(depth_.pixels<std::uint16_t>());
    frame.color = color_.pixels<Rgb8>();
    depth_.drop();
    color_.drop();
    if (!has_depth(frame.depth)) return std::nullopt;
    return frame;
  }

  static double time_s(const OniFrame& image) {
    return static_cast<double>(image.timestamp) / kStampsPerSecond;
  }

  const FrameSourceConfig config_;
  OpenNiLibrary library_;
  Device device_;
  const bool registered_;
  OpenNiStream depth_, color_;
  const CameraRig rig_;
  const DepthUnits units_;
};

}  // namespace

std::unique_ptr<RgbdCamera> open_openni_camera(const std::string& uri,
                                               const FrameSourceConfig& config) {
  return std::make_unique<OpenNiCamera>(uri, config);
}

}  // namespace ovimap
