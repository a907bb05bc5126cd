// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// PLY meshes of any kind.
#include "ovimap/base/error.h"
#include "ovimap/io/mesh/ply.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const ovimap::Mesh mesh = ovimap::decode_ply({data, size}, "input");
    for (const auto& triangle : mesh.triangles)
      for (const std::uint32_t corner : triangle)
        if (corner >= mesh.vertices.size()) __builtin_trap();
  } catch (const ovimap::Error&) {
  }
  return 0;
}
