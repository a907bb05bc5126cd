// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <OniCAPI.h>

namespace ovimap {

/// libOpenNI2, loaded when a camera is asked for: the program runs where it is not installed.
class OpenNiLibrary {
 public:
  /// Throws Error when it is not there, or is no OpenNI 2.
  OpenNiLibrary();
  ~OpenNiLibrary();
  OpenNiLibrary(const OpenNiLibrary&) = delete;
  OpenNiLibrary& operator=(const OpenNiLibrary&) = delete;

  /// What it says of its last fault, in one line.
  std::string fault() const;

 private:
  void* const library_;  // loaded before the functions are looked up
  template <class Function>
  Function* find(const char* name) const {
    return reinterpret_cast<Function*>(find_symbol(name));
  }
  void* find_symbol(const char* name) const;

 public:
  // The library's own functions, by their names without "oni".
#define OVIMAP_ONI(name) \
  decltype(::oni##name)* const name = find<decltype(::oni##name)>("oni" #name)
  OVIMAP_ONI(Initialize);
  OVIMAP_ONI(Shutdown);
  OVIMAP_ONI(GetExtendedError);
  OVIMAP_ONI(GetDeviceList);
  OVIMAP_ONI(ReleaseDeviceList);
  OVIMAP_ONI(RegisterDeviceCallbacks);
  OVIMAP_ONI(UnregisterDeviceCallbacks);
  OVIMAP_ONI(WaitForAnyStream);
  OVIMAP_ONI(DeviceOpen);
  OVIMAP_ONI(DeviceClose);
  OVIMAP_ONI(DeviceGetInfo);
  OVIMAP_ONI(DeviceGetSensorInfo);
  OVIMAP_ONI(DeviceCreateStream);
  OVIMAP_ONI(DeviceEnableDepthColorSync);
  OVIMAP_ONI(DeviceSetProperty);
  OVIMAP_ONI(DeviceIsImageRegistrationModeSupported);
  OVIMAP_ONI(StreamDestroy);
  OVIMAP_ONI(StreamStart);
  OVIMAP_ONI(StreamStop);
  OVIMAP_ONI(StreamReadFrame);
  OVIMAP_ONI(StreamSetProperty);
  OVIMAP_ONI(StreamGetProperty);
  OVIMAP_ONI(FrameRelease);
#undef OVIMAP_ONI
};

}  // namespace ovimap
