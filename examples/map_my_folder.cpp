// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// How do I map my recording? Usage: map_my_folder RECORDING MAP
#include <cstdio>

#include "ovimap/io/map_file/map_file.h"
#include "ovimap/pipeline/sequence/sequence_run.h"

int main(int argc, char** argv) try {
  if (argc != 3) throw ovimap::Error("usage: map_my_folder RECORDING MAP");
  const auto source = ovimap::open_frame_source(argv[1]);
  ovimap::Mapper mapper({});  // no 2D masks: depth alone
  const auto all_frames = ovimap::positions({}, source->size());
  const auto sequence = ovimap::run_sequence(*source, all_frames, mapper);
  const auto document = ovimap::make_document(std::move(mapper), sequence, {argv[1]});
  ovimap::save_map(argv[2], document);
  std::printf("%zu objects from %zu frames\n", document.instances.size(), sequence.frames.size());
} catch (const ovimap::Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
