// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "ovimap/synth/camera/walk.h"
#include "ovimap/synth/furniture/furniture_catalog.h"
#include "ovimap/synth/procedural/made_model.h"
#include "ovimap/synth/rooms/room.h"

namespace ovimap {

/// A place of apartments-v1 or desks-v1, and how it is filmed.
struct BenchmarkScene {
  std::string name;
  Split split = Split::kTuned;
  WalkConfig walk;
};

inline constexpr const char* kApartmentsV1 = "apartments-v1";
inline constexpr const char* kDesksV1 = "desks-v1";

/// Flats of several rooms, 8 to 12 m across, furnished with what is made by rule: doors that stand
/// open, pale furniture of many cushions and panels, small things on everything.
std::vector<BenchmarkScene> apartments_v1();
/// Desks, tables and shelves with 20 to 40 small and flat things each, filmed by hand.
std::vector<BenchmarkScene> desks_v1();

/// The scenes of the set of that name; of a scene's own name, that one; empty for any other name.
std::vector<BenchmarkScene> benchmark_scenes(const std::string& name);

/// Builds and furnishes it; another seed furnishes it anew, of the same half. Throws what
/// build_plan throws.
SynthRoom build_benchmark_scene(
    const BenchmarkScene& scene, std::uint64_t seed,
    const std::filesystem::path& furniture_folder = default_furniture_folder());

}  // namespace ovimap
