// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// How do I map from a camera, while it runs? Hand it every frame; everything else happens on
// threads. Usage: map_live RECORDING MAP; the recording stands for the camera here.
#include <cstdio>

#include "ovimap/io/map_file/map_file.h"
#include "ovimap/pipeline/live/live_run.h"

int main(int argc, char** argv) try {
  if (argc != 3) throw ovimap::Error("usage: map_live RECORDING MAP");
  const auto camera = ovimap::open_frame_source(argv[1]);
  ovimap::SequenceResult sequence;
  ovimap::LiveMapper mapper({}, {});
  for (std::int64_t i = 0; i < camera->size(); ++i) {
    ovimap::FrameRead read = camera->read(i);  // your driver: colour, depth in metres, pose
    if (!read.frame) continue;
    sequence.depth_camera = read.frame->depth_camera;
    mapper.push_and_wait(std::move(*read.frame));  // a camera cannot wait: push() drops instead
  }
  mapper.drain();
  if (mapper.frames().empty()) throw ovimap::Error("no frame could be read");
  sequence.frames = mapper.frames();
  const ovimap::LiveStatistics done = mapper.statistics();
  const auto document = ovimap::make_document(mapper.take(), sequence, {argv[1]});
  ovimap::save_map(argv[2], document);
  std::printf("%zu objects from %zu frames, each in the map after %.0f ms\n",
              document.instances.size(), sequence.frames.size(), done.geometry_lag.p50_ms);
} catch (const ovimap::Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
