// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// PNG and JPEG: colour, grey values, and the crops that a map keeps.
#include "ovimap/base/error.h"
#include "ovimap/image/codec.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span bytes(data, size);
  try {
    (void)ovimap::decode_rgb(bytes);
  } catch (const ovimap::Error&) {
  }
  try {
    (void)ovimap::decode_gray(bytes);
  } catch (const ovimap::Error&) {
  }
  return 0;
}
