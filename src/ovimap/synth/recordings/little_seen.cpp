// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/recordings/little_seen.h"

#include <Eigen/Geometry>

namespace ovimap {
namespace {

constexpr float kFullFrame_px = 640 * 480;

std::vector<float> areas_by_id(const Mesh& truth, std::size_t ids) {
  std::vector<float> areas(ids + 1, 0);
  for (const auto& [a, b, c] : truth.triangles) {
    const std::uint32_t id = truth.labels[a];
    if (id != truth.labels[b] || id != truth.labels[c] || id > ids) continue;
    areas[id] +=
        0.5f *
        (truth.vertices[b] - truth.vertices[a]).cross(truth.vertices[c] - truth.vertices[a]).norm();
  }
  return areas;
}

/// In how many frames each id has enough pixels.
std::vector<int> frames_by_id(const SynthSequence& sequence, std::size_t ids, float least_pixels) {
  std::vector<int> frames(ids + 1, 0);
  for (std::int64_t position = 0; position < sequence.size(); ++position) {
    std::vector<int> pixels(ids + 1, 0);
    const auto truth = sequence.truth_ids(position);  // outlives the loop over what it holds
    for (const std::uint16_t id : *truth) ++pixels[id];
    for (std::size_t id = 1; id <= ids; ++id)
      frames[id] += static_cast<float>(pixels[id]) >= least_pixels ? 1 : 0;
  }
  return frames;
}

}  // namespace

std::vector<std::uint32_t> little_seen(const SynthSequence& sequence, const Mesh& truth,
                                       const ScoredThingsConfig& config) {
  const auto& objects = sequence.room().objects;
  const PinholeCamera& camera = sequence.camera();
  const float share = static_cast<float>(camera.width * camera.height) / kFullFrame_px;
  const std::vector<float> areas = areas_by_id(truth, objects.size());
  const std::vector<int> frames =
      frames_by_id(sequence, objects.size(), share * static_cast<float>(config.least_pixels));
  std::vector<std::uint32_t> ids;
  for (const RoomObject& object : objects)
    if (object.box.sizes().maxCoeff() < config.least_side_m ||
        areas[object.id] < config.least_area_m2 || frames[object.id] < config.least_frames)
      ids.push_back(object.id);
  return ids;
}

}  // namespace ovimap
