// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include "ovimap/base/parallel.h"
#include "ovimap/frames/frame/rectification.h"

namespace ovimap::bench {
namespace {

/// Colour and depth of 640x480 through a strong lens; the argument is the number of threads.
void rectify(benchmark::State& state) {
  const ThreadLimit limit(static_cast<int>(state.range(0)));
  CameraRig rig;
  rig.color_camera = rig.depth_camera = {640, 480, 500.f, 500.f, 319.5f, 239.5f};
  rig.color_lens = rig.depth_lens = {Lens::Model::kBrownConrady, {-.28, .09, .001, -.0007, -.01}};
  const RigRectification rectification(rig);
  Frame frame;
  frame.color = RgbImage(640, 480);
  for (std::size_t i = 0; i < frame.color.size(); ++i)
    frame.color[i] = {static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(i >> 8), 7};
  frame.depth = DepthImage(640, 480, 2.f);
  for (auto _ : state) {
    rectification.apply(frame);
    benchmark::DoNotOptimize(frame);
  }
}
BENCHMARK(rectify)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace ovimap::bench
