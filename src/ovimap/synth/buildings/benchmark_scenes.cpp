// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/buildings/benchmark_scenes.h"

#include <algorithm>

#include "ovimap/base/error.h"
#include "ovimap/synth/buildings/desk_corners.h"
#include "ovimap/synth/buildings/flats.h"
#include "ovimap/synth/buildings/room_builder.h"

namespace ovimap {
namespace {

constexpr float kFlatFps = 2, kDeskFps = 2;
constexpr std::uint64_t kSceneStream = 8001;

/// Somebody who stands and leans over a desk: the arms move more than the feet.
WalkConfig standing() {
  WalkConfig walk;
  walk.fps = kDeskFps;
  walk.eye_m = 1.35f;
  walk.steps_per_s = 0.5f;
  walk.rise_m = 0.01f, walk.sideways_m = 0.02f;
  walk.drift_m = 0.09f, walk.drift_rad = 0.05f;
  return walk;
}

}  // namespace

std::vector<BenchmarkScene> apartments_v1() {
  std::vector<BenchmarkScene> scenes;
  for (const Flat& flat : flats()) {
    BenchmarkScene scene{flat.plan.name, flat.split, {}};
    scene.walk.fps = kFlatFps;
    scenes.push_back(scene);
  }
  return scenes;
}

std::vector<BenchmarkScene> desks_v1() {
  std::vector<BenchmarkScene> scenes;
  for (const DeskCorner& corner : desk_corners())
    scenes.push_back({corner.spec.name, corner.spec.split, standing()});
  return scenes;
}

std::vector<BenchmarkScene> benchmark_scenes(const std::string& name) {
  if (name == kApartmentsV1) return apartments_v1();
  if (name == kDesksV1) return desks_v1();
  std::vector<BenchmarkScene> found = apartments_v1();
  for (const BenchmarkScene& scene : desks_v1()) found.push_back(scene);
  std::erase_if(found, [&](const BenchmarkScene& scene) { return scene.name != name; });
  return found;
}

SynthRoom build_benchmark_scene(const BenchmarkScene& scene, std::uint64_t seed,
                                const std::filesystem::path& furniture_folder) {
  for (Flat& flat : flats())
    if (flat.plan.name == scene.name) {
      flat.plan.seed = Random(seed, kSceneStream).bits();
      return build_plan(flat.plan, furniture_folder);
    }
  for (DeskCorner& corner : desk_corners())
    if (corner.spec.name == scene.name) {
      corner.spec.seed = Random(seed, kSceneStream).bits();
      SynthRoom room = build_room(corner.spec, furniture_folder);
      room.survey = survey_of(room, corner.main_class, corner.main_class == "bookshelf");
      return room;
    }
  throw Error("scene '" + scene.name + "': of no benchmark");
}

}  // namespace ovimap
