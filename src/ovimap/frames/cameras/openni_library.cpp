// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/cameras/openni_library.h"

#include <dlfcn.h>

#include <algorithm>

#include "ovimap/base/error.h"

namespace ovimap {

namespace {

constexpr const char* kFile = "libOpenNI2.so.0";

void* load_library() {
  if (void* library = ::dlopen(kFile, RTLD_NOW | RTLD_LOCAL)) return library;
  throw Error(concat("OpenNI cameras need the library ", kFile,
                     ", which cannot be loaded; install it with: apt-get install libopenni2-0"));
}

}  // namespace

// It stays loaded: its drivers leave threads behind.
OpenNiLibrary::OpenNiLibrary() : library_(load_library()) {
  if (Initialize(ONI_API_VERSION) != ONI_STATUS_OK)
    throw Error(
        concat("OpenNI cannot be started (", fault(), "); is libopenni2-0 installed whole?"));
}

OpenNiLibrary::~OpenNiLibrary() {
  Shutdown();
}

std::string OpenNiLibrary::fault() const {
  std::string text = GetExtendedError();
  text.erase(0, std::min(text.find_first_not_of(" \t\r\n"), text.size()));
  return text.substr(0, text.find_first_of("\r\n"));
}

void* OpenNiLibrary::find_symbol(const char* name) const {
  if (void* symbol = ::dlsym(library_, name)) return symbol;
  throw Error(concat(kFile, " has no function ", name, "; accepted is OpenNI 2.2"));
}

}  // namespace ovimap
