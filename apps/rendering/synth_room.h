// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "ovimap/synth/buildings/benchmark_scenes.h"
#include "ovimap/synth/furniture/furniture_catalog.h"
#include "ovimap/synth/recordings/sequence.h"

namespace ovimap::apps {

struct RoomOptions {
  std::filesystem::path furniture = default_furniture_folder();
  std::string room = "tiny";     ///< one of room_names
  std::filesystem::path models;  ///< of a room: JSON of RoomSpec::models; empty: any
  int frames = 0;                ///< 0: as the room says
  std::uint64_t seed = 1;
  SynthSequenceConfig frames_as;        ///< exact, or as some sensor sees them
  std::string plan;                     ///< one of floor_plan_names, with a video; empty: the room
  std::optional<BenchmarkScene> scene;  ///< instead of a room or a plan, with a video
  std::optional<VideoConfig> video;     ///< the video of a walk instead of frames from all sides
  int width = 0, height = 0;            ///< pixels; 0: as the room says
};

struct WrittenRoom {
  std::string scene;  ///< the folder
  std::int64_t frames = 0;
  std::size_t objects = 0;
  std::vector<std::uint32_t> moving = {};  ///< instance ids of what moves while it is filmed
};

/// Renders a room into the recording `out`/`scene`. Throws Error for an unknown room and what
/// cannot be written.
WrittenRoom write_room(
    const std::filesystem::path& out, const RoomOptions& options, const std::string& scene,
    const std::function<void(std::int64_t done, std::int64_t total)>& progress = {});

/// Renders `visits` visits to a room (plan_visits) in one world frame into the recordings
/// `out`/visit1, `out`/visit2, ..., and what changed between them into `out`/changes.json
/// (docs/changes.md). Throws likewise.
std::vector<WrittenRoom> write_visits(
    const std::filesystem::path& out, const RoomOptions& options, int visits,
    const std::function<void(std::int64_t done, std::int64_t total)>& progress = {});

}  // namespace ovimap::apps
