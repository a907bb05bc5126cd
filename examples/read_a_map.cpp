// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// What is in my map? Usage: read_a_map MAP
#include <cstdio>

#include "ovimap/base/error.h"
#include "ovimap/io/map_file/map_file.h"

int main(int argc, char** argv) try {
  if (argc != 2) throw ovimap::Error("usage: read_a_map MAP");
  const ovimap::MapInfo map =
      ovimap::read_map_info(argv[1]);  // instances alone; load_map reads the voxels too
  for (const ovimap::InstanceSummary& instance : map.instances) {
    const Eigen::Vector3f center = instance.box.center();
    std::printf("object %u at %.2f %.2f %.2f, seen in %d frames\n", instance.id, center.x(),
                center.y(), center.z(), instance.views);
  }
} catch (const ovimap::Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
